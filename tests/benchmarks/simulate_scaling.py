#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Scaling on paper: plays a frame's messages and tiles for any number of ranks, fed by what was measured.

    simulate_scaling.py [--bench build/bin/dsm_bench] [--ranks 1,2,4,...] [--pixels 2048] ...

First measures on this machine: what each tile costs, what a message costs, and the frames/s of 1 to 4
ranks with one thread each, which the simulation has to reproduce. Then says what it expects of more
ranks, each with a core of its own, for a larger picture, with both load balancers.

The model: a rank's communication thread treats one message after the other (`message` seconds each,
besides its tracing thread), and a message is on its way for `latency` seconds. A frame has collective
steps, in which rank 0 hears from every rank, and tells all along a binomial tree.
"""
import argparse
import heapq
import math
import random

from measuring import BENCH, run_bench

COLLECTIVE_STEPS = 4  # of a frame: the request, the store's beginning, the end's report and its answer
SHARES_LEFT = 4  # see CentralQueueScheduler
MOST_VICTIMS = 16  # see WorkStealingScheduler


class Cluster:
    """Ranks with a mailbox each, and a queue of what happens next."""

    def __init__(self, ranks, message, latency, slowness):
        self.now = 0.0
        self.message, self.latency, self.slowness = message, latency, slowness
        self.events = []
        self.count = 0
        self.free = [0.0] * ranks  # when a communication thread has treated what it was sent

    def at(self, time, action):
        self.count += 1
        heapq.heappush(self.events, (time, self.count, action))

    def send(self, to, action):
        """The receiver treats it when it arrives and those before it are treated."""
        def arrive():
            self.free[to] = max(self.free[to], self.now) + self.message * self.slowness
            self.at(self.free[to], action)
        self.at(self.now + self.latency, arrive)

    def run(self):
        while self.events:
            self.now, _, action = heapq.heappop(self.events)
            action()
        return self.now


def play_queue(cluster, ranks, costs):
    """Until the last tile is traced; rank 0 deals out tiles, its own worker takes them one by one."""
    state = {"next": 0, "end": 0.0}
    granted = [[] for _ in range(ranks)]
    asked = [False] * ranks
    over = [False] * ranks
    waits = [True] * ranks

    def take(count):
        first = state["next"]
        state["next"] = min(first + count, len(costs))
        return list(range(first, state["next"]))

    def trace(rank):
        if rank == 0:
            granted[0] += take(1)
        elif len(granted[rank]) <= 1 and not asked[rank] and not over[rank]:
            asked[rank] = True
            cluster.send(0, lambda: grant(rank))
        if granted[rank]:
            waits[rank] = False
            cluster.at(cluster.now + costs[granted[rank].pop(0)] * cluster.slowness,
                       lambda: trace(rank))
            state["end"] = max(state["end"], cluster.now)
        else:
            waits[rank] = True
            state["end"] = max(state["end"], cluster.now)

    def grant(rank):
        left = len(costs) - state["next"]
        tiles = take(max(left // (SHARES_LEFT * ranks), 1))
        cluster.send(rank, lambda: receive(rank, tiles))

    def receive(rank, tiles):
        asked[rank] = False
        over[rank] = not tiles
        granted[rank] += tiles
        if waits[rank] and granted[rank]:
            trace(rank)

    for rank in range(ranks):
        trace(rank)
    cluster.run()
    return state["end"]


def play_stealing(cluster, ranks, costs, own):
    """`own`: the tiles that each rank begins with. Returns the end, and who traced what."""
    own = [list(tiles) for tiles in own]
    traced = [[] for _ in range(ranks)]
    victims = []
    for rank in range(ranks):
        others = [other for other in range(ranks) if other != rank]
        victims.append(random.sample(others, min(len(others), MOST_VICTIMS)))
    waits = [False] * ranks
    end = [0.0]

    def trace(rank):
        end[0] = max(end[0], cluster.now)
        if own[rank]:
            waits[rank] = False
            tile = own[rank].pop(0)
            traced[rank].append(tile)
            cluster.at(cluster.now + costs[tile] * cluster.slowness, lambda: trace(rank))
        else:
            waits[rank] = True
        if not own[rank] and victims[rank] and not asking[rank]:
            asking[rank] = True
            cluster.send(victims[rank][-1], lambda: give(victims[rank][-1], rank))

    def give(victim, thief):
        half = len(own[victim]) // 2
        tiles = own[victim][len(own[victim]) - half:]
        del own[victim][len(own[victim]) - half:]
        cluster.send(thief, lambda: receive(thief, tiles))

    def receive(rank, tiles):
        asking[rank] = False
        if not tiles:
            victims[rank].pop()
        own[rank] += tiles
        if waits[rank]:
            trace(rank)

    asking = [False] * ranks
    for rank in range(ranks):
        trace(rank)
    cluster.run()
    return end[0], traced


def simulate(balancer, ranks, costs, message, latency, cores=None, frames=6):
    """Seconds of a frame, once the balance of the frames before has settled."""
    slowness = max(1.0, ranks / cores) if cores else 1.0
    depth = math.ceil(math.log2(ranks)) if ranks > 1 else 0
    collective = ((ranks - 1) * message + depth * (message + latency) + latency) * slowness
    overhead = COLLECTIVE_STEPS * collective if ranks > 1 else 0.0
    if balancer == "queue":
        return overhead + play_queue(Cluster(ranks, message, latency, slowness), ranks, costs)
    own = [list(range(len(costs) * rank // ranks, len(costs) * (rank + 1) // ranks))
           for rank in range(ranks)]
    for _ in range(frames):
        seconds, own = play_stealing(
            Cluster(ranks, message, latency, slowness), ranks, costs, own)
    return overhead + seconds


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", default=BENCH)
    parser.add_argument("--volume", default="rm:128:float")
    parser.add_argument("--isovalue", default="127.5")
    parser.add_argument("--ranks", default="8,16,32,64,128,256,512,1000")
    parser.add_argument("--pixels", type=int, default=2048, help="edge of the larger picture")
    parser.add_argument("--latency", type=float, default=20.0, help="of the larger cluster, microseconds")
    parser.add_argument("--cores", type=int, default=2, help="that this machine has")
    arguments = parser.parse_args()
    random.seed(1)
    options = {"volume": arguments.volume, "isovalue": arguments.isovalue, "threads": 1,
               "frames": 20, "repeat": 2}

    costs = run_bench(arguments.bench, 1, "isosurface", tile_seconds="on", **options)["tile_seconds"]
    exchange = run_bench(arguments.bench, 2, "access", sizes=8, block=4096, accesses=1000,
                         misses=500, threads=1)["misses"]["exchange_us"] * 1e-6
    message = latency = exchange / 4  # two messages there and back, each treated and on its way
    print(f"tiles: {len(costs)}, {1e6 * sum(costs) / len(costs):.0f} us each on the mean, "
          f"{1e6 * max(costs):.0f} us at most; a message: {1e6 * message:.1f} us to treat")
    print("balancer  ranks   measured ms   simulated ms   ratio")
    for balancer in ("queue", "stealing"):
        for ranks in (1, 2, 3, 4):
            result = run_bench(arguments.bench, ranks, "isosurface", scheduler=balancer, **options)
            measured = 1.0 / result["frames_per_second"]
            simulated = simulate(balancer, ranks, costs, message, latency, arguments.cores)
            print(f"{balancer:9}{ranks:6}{1e3 * measured:14.2f}{1e3 * simulated:15.2f}"
                  f"{simulated / measured:8.2f}", flush=True)

    # The same picture, finer: tiles of the same size, so as many times more of the same costs.
    more = (arguments.pixels // 512) ** 2
    larger = [cost for cost in costs for _ in range(more)]
    print(f"\n{arguments.pixels} x {arguments.pixels} pixels, a core for each rank, "
          f"{arguments.latency:g} us from rank to rank")
    print("ranks   queue: frames/s   efficiency   stealing: frames/s   efficiency")
    for ranks in [int(part) for part in arguments.ranks.split(",")]:
        row = f"{ranks:5}"
        for balancer in ("queue", "stealing"):
            seconds = simulate(balancer, ranks, larger, message, 1e-6 * arguments.latency)
            row += f"{1 / seconds:18.1f}{sum(larger) / ranks / seconds:13.2f}"
        print(row, flush=True)


if __name__ == "__main__":
    main()
