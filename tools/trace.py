#!/usr/bin/env python3
"""Summarises a trace of `vantage live --trace FILE`: the time of each step by thread, and the way of the slowest inputs.

  tools/trace.py FILE [--slowest N]

An input's time is from its arrival to the hand-over of the first picture that shows it, as the summary's "input to picture".
"""
import argparse
import collections
import json

INPUT = 4  # TraceId::of_input() in common/base/trace/trace.h


def load(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    try:
        return json.loads(text)
    except json.JSONDecodeError:
        return json.loads(text + "]")  # the program was killed


def percentile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, int(share * len(values)))]


def print_table(head, rows):
    widths = [max(len(row[i]) for row in [head, *rows]) for i in range(len(head))]
    for row in [head, *rows]:
        print("  ".join(cell.ljust(width) if i < 2 else cell.rjust(width) for i, (cell, width) in enumerate(zip(row, widths))).rstrip())


def steps(spans, tracks):
    times = collections.defaultdict(list)
    for span in spans:
        times[tracks.get(span["tid"], str(span["tid"])), span["name"]].append(span["dur"] / 1e3)
    rows = [
        [track, name, str(len(ms))] + [f"{value:.2f}" for value in (percentile(ms, 0.5), percentile(ms, 0.99), max(ms), sum(ms) / 1e3)]
        for (track, name), ms in sorted(times.items())
    ]
    print_table(["thread", "step", "number", "p50 ms", "p99 ms", "most ms", "sum s"], rows)


def ways(spans, flows):
    """The way of each input that changed a picture: its arrival in us, the camera's sample and the hand-over of the picture, as spans."""
    by_place = {(span["tid"], span["ts"], span["name"]): span for span in spans}
    members = collections.defaultdict(dict)
    for flow in flows:
        for name in ("camera sample", "hand over"):
            span = by_place.get((flow["tid"], flow["ts"], name))
            if span and int(flow["id"], 16) >> 56 == INPUT:
                members[int(flow["id"], 16)][name] = span
    return [
        ((number & (1 << 56) - 1) / 1e3, found["camera sample"], found["hand over"])
        for number, found in members.items()
        if len(found) == 2
    ]


def main():
    parser = argparse.ArgumentParser(description="Summarise a trace of vantage live, play or demo.")
    parser.add_argument("file", help="trace (JSON)")
    parser.add_argument("--slowest", type=int, default=3, help="print the way of this many slowest inputs (default: 3)")
    options = parser.parse_args()
    events = load(options.file)
    tracks = {event["tid"]: event["args"]["name"] for event in events if event["name"] == "thread_name"}
    spans = [event for event in events if event["ph"] == "X"]
    flows = [event for event in events if "id" in event]
    if not spans:
        parser.exit(1, f"{options.file} has no spans\n")
    steps(spans, tracks)
    inputs = ways(spans, flows)
    if not inputs:
        print("\nno input changed a picture")
        return
    total_ms = [(handed["ts"] - arrival) / 1e3 for arrival, _, handed in inputs]
    waits_ms = [(sample["ts"] - arrival) / 1e3 for arrival, sample, _ in inputs]
    print(f"\ninput to hand-over, {len(inputs)} inputs: p50 {percentile(total_ms, 0.5):.1f}, p99 {percentile(total_ms, 0.99):.1f}, "
          f"most {max(total_ms):.1f} ms; of it until the camera was sampled: p50 {percentile(waits_ms, 0.5):.1f}, most {max(waits_ms):.1f} ms")
    for arrival, sample, handed in sorted(inputs, key=lambda way: way[0] - way[2]["ts"])[: options.slowest]:
        print(f"\n{(handed['ts'] - arrival) / 1e3:.1f} ms: sampled after {(sample['ts'] - arrival) / 1e3:.1f} ms; meanwhile, in ms after the input:")
        for span in sorted(spans, key=lambda span: span["ts"]):
            begin, end = (span["ts"] - arrival) / 1e3, (span["ts"] + span["dur"] - arrival) / 1e3
            if end > 0 and span["ts"] <= handed["ts"] and (span["dur"] > 2000 or span["name"] in ("tick", "camera sample", "hand over")):
                print(f"  {begin:7.1f} to {end:7.1f}  {tracks.get(span['tid'], '')}: {span['name']}")


if __name__ == "__main__":
    main()
