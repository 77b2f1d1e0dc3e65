#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Measures the rows of the table "The demo" in docs/figures.md, and prints the table. Takes about a minute.
Needs the programs of the target `benchmarks`.

usage: scripts/figures/figures.py [SUMMARY.json]   (default: out/demo/summary.json, as scripts/demo.sh leaves it)
"""

import json
import pathlib
import subprocess
import sys

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "launcher"))
from ask import session_results

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = ROOT / "build" / "release" / "bin"


def benchmark(program, pattern):
    """Returns the median results of a Google Benchmark program, by name."""
    command = [BIN / program, f"--benchmark_filter={pattern}", "--benchmark_format=json",
               "--benchmark_repetitions=5", "--benchmark_report_aggregates_only=true"]
    output = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    results = json.loads(output)["benchmarks"]
    return {r["run_name"].split("/iterations:")[0]: r for r in results if r["aggregate_name"] == "median"}


def micro(result):
    """Returns the CPU time of a result [µs]."""
    return result["cpu_time"] * {"ns": 1e-3, "us": 1, "ms": 1e3}[result["time_unit"]]


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":")[1].strip()
    return "unknown processor"


def sand_rows():
    sand = benchmark("sand_bench", "sweep/G/512|sweep/G_baseline/512|memcpy/512|dig/(paper_tool|tool_of_12_cells)/|idle")
    sweep, copy = sand["sweep/G/512"]["ns_per_cell"], sand["memcpy/512"]["ns_per_cell"]
    baseline = sand["sweep/G_baseline/512"]["ns_per_cell"]
    yield f"G sweep at 512², {sand['sweep/G/512']['label']}", f"{sweep:.2f} ns per cell", f"{sweep / copy:.1f} × memcpy of the same bytes ({copy:.3f} ns)"
    yield "the same, baseline x86-64", f"{baseline:.2f} ns per cell", f"{baseline / copy:.1f} × memcpy"
    yield "a step of digging, R = 2.56 cells", f"{micro(sand['dig/paper_tool']) / 1e3:.2f} ms", "one core, hash included"
    yield "a step of digging, R = 12 cells", f"{micro(sand['dig/tool_of_12_cells']) / 1e3:.2f} ms", "24 sweeps"
    yield "a step of settled sand", f"{micro(sand['idle']):.2f} µs", "no sweeps"


def force_row():
    command = [BIN / "force_bench", "--benchmark_filter=forceTick", "--benchmark_format=json"]
    rows = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)["benchmarks"]
    p50, p99 = (max(row[name] for row in rows) for name in ("p50_us", "p99_us"))
    yield "force evaluation per tick, p50, p99", f"{p50:.1f} µs, {p99:.1f} µs", "of 1000 µs; either law, up to 20 cells"


def draw_rows():
    draw = benchmark("draw_bench", "drawWall/culled:1/cells:512")
    view = next(iter(draw.values()))
    yield "drawing one eye of a tile, 1024×768", f"{view['real_time']:.1f} ms", f"llvmpipe; {view['chunks_per_tile']:.0f} of {view['chunks_of_field']:.0f} chunks"


def session_rows(summary):
    ranks = summary["per_rank"]
    memory = max(rank["memory_bytes"] for rank in ranks) / 2**20
    slowest = max(rank["draw_ms"]["p99"] for rank in ranks)
    message = summary["broadcast_bytes"]
    haptic = summary["haptic"]
    yield "frame drawing per tile, both eyes, p99 of the slowest rank", f"{slowest:.0f} ms", f"{len(ranks)} ranks on one machine"
    yield "resident memory per render rank", f"{memory:.0f} MiB", f"frame buffers {ranks[0]['frame_buffer_bytes'] / 2**20:.0f} MiB of it"
    yield "frame message", f"{message['p50']:.0f} bytes (p99 {message['p99']:.0f})", "at most 8 steps"
    yield "step message over TCP", f"{haptic['step_message_bytes']:.0f} bytes", ""
    period = summary["haptic_period_us"]
    yield "haptic period", f"p50 {period['p50']:.0f} µs, p99 {period['p99']:.0f} µs", ""
    skew = summary["skew_us"]
    yield "swap skew", f"p50 {skew['p50']:.0f} µs, p99 {skew['p99']:.0f} µs", "processes that share cores: scheduler noise"


def main():
    file = sys.argv[1] if len(sys.argv) > 1 else ROOT / "out" / "demo" / "summary.json"
    if not pathlib.Path(file).is_file():
        print(f"{file}: does not exist; run scripts/demo.sh first", file=sys.stderr)
        return 2
    summary = session_results.read_summary(file)
    print(f"| {processor()} | | |\n|---|---|---|")
    for rows in (sand_rows(), force_row(), draw_rows(), session_rows(summary)):
        for what, figure, beside in rows:
            print(f"| {what} | {figure} | {beside} |")
    return 0


if __name__ == "__main__":
    sys.exit(main())
