#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The paper's Fig. 10, and the count behind its Fig. 9: both load balancers against the cache's size.

    balancers.py [--bench build/bin/dsm_bench] [--ranks 2] [--threads 1] [--volume rm:128:float] ...

Plays session.txt; prints misses, frames/s, imbalance (the busiest rank's time over the mean), and how
many tiles change hands from frame to frame. Both take turns, so that other programs disturb both.
"""
import argparse

from measuring import BENCH, SESSION, run_bench


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", default=BENCH)
    parser.add_argument("--ranks", type=int, default=2)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--volume", default="rm:128:float")
    parser.add_argument("--isovalue", default="127.5")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--latency", default="0", help="microseconds added to every message")
    parser.add_argument("--cache", default="1,0.5,0.25,0.16,0.1,0.05")
    arguments = parser.parse_args()
    print("cache  balancer   misses/frame   frames/s   imbalance   tiles that change hands/frame")
    for cache in [float(part) for part in arguments.cache.split(",")]:
        for scheduler in ("queue", "stealing"):
            result = run_bench(
                arguments.bench, arguments.ranks, "isosurface", volume=arguments.volume,
                isovalue=arguments.isovalue, size=arguments.size, threads=arguments.threads,
                session=SESSION, scheduler=scheduler, latency=arguments.latency,
                cache_fraction=cache, repeat=2)
            busy = [rank["busy_seconds"] for rank in result["ranks"]]
            frames = result["frames"]
            print(f"{cache:5.2f}  {scheduler:9}{(result['misses'] - result['joins']) / frames:14.1f}"
                  f"{result['frames_per_second']:11.2f}{max(busy) * len(busy) / sum(busy):12.3f}"
                  f"{result['new_tiles'] / frames:16.1f}", flush=True)


if __name__ == "__main__":
    main()
