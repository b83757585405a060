#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""The paper's Table 3 and Fig. 12: accesses and misses per worker and frame, by ranks and data.

    many_ranks.py [--ranks 8,16,31] [--edges 64,128,256] [--memory 10] [--scheduler stealing] ...

Each volume has eight times the samples of the one before; each rank has the same memory (MiB), for its
own bricks and its cache. One tracing thread a rank, ranks as hosts of their own. Counts are exact on
any machine; times mean nothing where ranks are more than cores.
"""
import argparse

from measuring import BENCH, run_bench


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bench", default=BENCH)
    parser.add_argument("--ranks", default="8,16,31")
    parser.add_argument("--edges", default="64,128,256")
    parser.add_argument("--memory", default="10", help="MiB per rank")
    parser.add_argument("--scheduler", default="stealing")
    parser.add_argument("--overlap", default="1", help="workers per thread; the paper had one")
    parser.add_argument("--frames", default="60", help="camera positions around the volume")
    arguments = parser.parse_args()
    print("samples  ranks   accesses/worker/frame   misses/worker/frame   hit rate   MiB received")
    for edge in arguments.edges.split(","):
        for ranks in [int(part) for part in arguments.ranks.split(",")]:
            result = run_bench(
                arguments.bench, ranks, "isosurface", volume=f"rm:{edge}:float", isovalue=127.5,
                threads=1, store="object", memory=arguments.memory, frames=arguments.frames,
                repeat=2, overlap=arguments.overlap, scheduler=arguments.scheduler)
            share = result["frames"] * ranks
            misses = result["misses"] - result["joins"]
            print(f"{edge:>4}^3 {ranks:8}{result['accesses'] / share:20.0f}{misses / share:22.2f}"
                  f"{1 - misses / result['accesses']:14.5f}"
                  f"{result['bytes_received'] / result['frames'] / 2 ** 20:12.2f}", flush=True)


if __name__ == "__main__":
    main()
