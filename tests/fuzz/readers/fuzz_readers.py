#!/usr/bin/env python3
"""Runs libFuzzer on every reader, one after the other. What it finds to be new is kept in build/fuzz/corpus; a finding ends with status 1."""

import argparse
import os
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
# A finding is also what takes longer, or more memory, than any sound file of that size can.
LIMITS = ["-timeout=10", "-rss_limit_mb=2048", "-malloc_limit_mb=1024", "-max_len=8192"]


def readers(programs):
    """(name, words, program) of each reader that reads in this process: those behind ITK are read by the driver, in processes of their own."""
    return [(*line.split(), programs / program)
            for program in ("incise_file_fuzz", "incise_result_fuzz")
            for line in subprocess.run([programs / program, "--list"], capture_output=True, text=True, check=True).stdout.splitlines()]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, required=True)
    parser.add_argument("--seconds", type=int, default=3600, help="for all readers together")
    parser.add_argument("--cases", type=int, help="for each reader, in place of --seconds")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only")
    request = parser.parse_args()
    chosen = [reader for reader in readers(request.programs.resolve()) if request.only in (None, reader[0])]
    if not chosen:
        parser.error(f"--only: found {request.only}, expected one of {' '.join(name for name, *_ in readers(request.programs))}")
    each = [f"-runs={request.cases}"] if request.cases else [f"-max_total_time={max(1, request.seconds // len(chosen))}"]
    status = 0
    for name, words, program in chosen:
        kept = request.programs.resolve().parents[2] / "corpus" / name
        kept.mkdir(parents=True, exist_ok=True)
        done = subprocess.run([program, f"--reader={name}", f"-dict={HERE / 'words' / words}.dict", f"-seed={request.seed}", *LIMITS, *each, "-print_final_stats=1",
                               f"-artifact_prefix={name}_", kept, HERE / "corpus" / name], env={**os.environ, "ASAN_OPTIONS": "detect_leaks=0"}, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, check=False)
        said = done.stderr.decode("utf-8", "replace")
        cases = re.findall(r"number_of_executed_units: (\d+)", said)
        coverage = [(int(case), int(edges)) for case, edges in re.findall(r"^#(\d+)\s.*?cov: (\d+)", said, re.MULTILINE)]
        edges = coverage[-1][1] if coverage else 0
        last_new = next((case for case, found in coverage if found == edges), 0)
        print(f"{name:18} {cases[-1] if cases else '?'} cases, {edges} edges, the last new one at case {last_new}: {'no finding' if done.returncode == 0 else 'a FINDING'}", flush=True)
        if done.returncode != 0:
            print(said[-6000:], flush=True)
            status = 1
    return status


if __name__ == "__main__":
    sys.exit(main())
