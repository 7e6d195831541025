#!/usr/bin/env python3
"""Prints the results of `hitscope bench` as a table per binary and number of threads.

    tests/bench_table.py [--binary HITSCOPE]... [--threads N]... MESH.obj [camera options]...

Several binaries (for example, one built for any CPU and one with RUSTFLAGS=-Ctarget-cpu=native) and several
thread counts are measured in turn. Rates are million rays per second of all threads by CPU time, medians over
all rounds. Ratios compare kernels in the same run. Camera options are those of `hitscope bench --help`.
"""
import argparse
import json
import subprocess

# Kernel, baseline kernel, and target ratio of their rates, if there is one.
RATIOS = [("exact", "watertight", 0.95), ("exact", "fast", None), ("watertight", "fast", 1 / 1.15), ("precise", "exact", None)]


def measured(binary, mesh, threads, camera):
    command = [binary, "bench", mesh, "--json", "--threads", str(threads), *camera]
    return json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout)


def megabytes(count):
    return "unknown" if count is None else f"{count / 1e6:.0f} MB"


def workload(row):
    """The workload's title; rays traced together are a workload of their own."""
    return row["name"] if row["rays_together"] == 1 else f"{row['name']} × {row['rays_together']}"


def rates(report):
    """The rate of each kernel and workload. Kernels without packets are measured twice with single rays: the first counts."""
    found = {}
    for row in report["workloads"]:
        found.setdefault((row["kernel"], workload(row)), row["mrays_per_s"])
    return found


def print_report(title, report):
    print(f"\n## {title}: {report['triangles']} triangles, SIMD {report['simd']}\n")
    print(f"load {report['load_ms']:.0f} ms, tree {report['build_ms']:.1f} ms, quick tree "
          f"{report['quick_build_ms']:.1f} ms; {report['bytes_per_triangle']:.1f} bytes per triangle; "
          f"peak {megabytes(report['peak_rss_bytes'])}\n")
    steps = report["load_steps_ms"].items()
    print("load, step by step: " + ", ".join(f"{step} {ms:.1f} ms" for step, ms in steps) + "\n")
    names = list(dict.fromkeys(workload(row) for row in report["workloads"]))
    kernels = list(dict.fromkeys(row["kernel"] for row in report["workloads"]))
    rate = rates(report)
    rate_text = lambda key: f"{rate[key]:.2f}" if key in rate else "–"
    ratio_text = lambda a, b: f"{rate[a] / rate[b]:.2f}" if a in rate and b in rate else "–"
    print("| Mrays/s | " + " | ".join(names) + " |")
    print("|---|" + "---|" * len(names))
    for kernel in kernels:
        print(f"| {kernel} | " + " | ".join(rate_text((kernel, name)) for name in names) + " |")
    for kernel, base, bar in RATIOS:
        if kernel in kernels and base in kernels:
            ratios = (ratio_text((kernel, name), (base, name)) for name in names)
            target = "" if bar is None else f", target {bar:.2f}"
            print(f"| {kernel} / {base}{target} | " + " | ".join(ratios) + " |")


def print_scaling(first, other, threads):
    print(f"\n{threads[1]} threads relative to {threads[0]}, by wall clock:", end=" ")
    for a, b in zip(first["workloads"], other["workloads"]):
        ratio = b["mrays_per_s_wall"] / a["mrays_per_s_wall"]
        print(f"{a['kernel']} {workload(a)} {ratio:.2f}", end="; ")
    print()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--binary", action="append")
    parser.add_argument("--threads", action="append", type=int)
    parser.add_argument("mesh")
    args, camera = parser.parse_known_args()
    threads = args.threads or [1]
    for binary in args.binary or ["target/release/hitscope"]:
        reports = []
        for count in threads:
            reports.append(measured(binary, args.mesh, count, camera))
            print_report(f"{args.mesh}, {binary}, {count} thread(s)", reports[-1])
        for count, report in zip(threads[1:], reports[1:]):
            print_scaling(reports[0], report, [threads[0], count])


try:
    main()
except (OSError, subprocess.CalledProcessError) as error:
    raise SystemExit(f"bench_table: {error}")
