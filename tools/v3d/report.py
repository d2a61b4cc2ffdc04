#!/usr/bin/env python3
"""Writes what Mesa's V3D compiler makes of a rig's shaders as Markdown, with lower bounds of a frame.

usage: report.py RUNS OUT.md [--check]
RUNS holds, for every run of tests/bench/rig_frame under the pretended GPU, NAME.json (its output) and NAME.err (stderr: Mesa's
V3D_DEBUG=shaderdb,qpu and the lines of gl_trace.c). With --check, OUT.md is compared with and left as it is; exit 1 where a limit
is exceeded.
"""
import json
import re
import sys
from math import prod
from pathlib import Path

# A GPU: QPUs, clock in Hz, and bytes per second read + written (copies measured elsewhere; a Pi 5 reaches 4 to 8 GB/s).
CHIPS = {
    '42': dict(name='Raspberry Pi 4 (V3D 4.2)', qpus=8, hz=500e6, bytes_per_s=2.5e9),
    '71': dict(name='Raspberry Pi 5 (V3D 7.1)', qpus=12, hz=960e6, bytes_per_s=4.0e9),
}
LIMITS = dict(spills=0, mali_spills=4, compile_ms=5000, threads=2, growth=1.03, dispatch_ms=100)
LANES, CYCLES_PER_BATCH = 16, 4  # a QPU issues an instruction for 16 lanes in 4 cycles

INSTRUCTION = re.compile(r'^0x[0-9a-f]{16} (.*)$')
LISTING = re.compile(r'^(MESA_SHADER_\w+)(?:/\w+)? prog \d+/\d+ QPU:')
SHADER_DB = re.compile(r'^SHADER-DB-(\S+) - (\S+) shader: (\d+) inst, (\d+) threads, (\d+) loops, (\d+) uniforms, '
                       r'(\d+) max-temps, (\d+):(\d+) spills:fills')
BRANCH = re.compile(r'^bu?\.?\S*\s+(-?\d+)')


def up(a, b):
    return -(-a // b)


class Program:
    def __init__(self, file, defines):
        self.file, self.defines = file, defines
        self.cpu_ms = 0.0
        self.code = None

    def label(self):
        shown = ('BOTH', 'ROW_PAIRS', 'ROWS_ONLY', 'ALONG', 'ADD', 'SLABS', 'GIVEN', 'KEEP', 'CELL', 'LAST', 'SHIFTED', 'ROW_STEP', 'OF_STREAM', 'FORMAT')
        return ' '.join(f'{k}={v}' for k, v in self.defines.items() if k in shown)


def parse(path):
    """Programs by GL name, and the runs (frame, program, groups) of frames 1 and later."""
    programs, runs = {}, []
    current, frame, listing, listings = None, None, None, []
    linking = {}
    for line in path.read_text(errors='replace').splitlines():
        instruction = INSTRUCTION.match(line)
        if listing is not None and instruction:
            listing.append(instruction.group(1))
            continue
        listing = None
        if LISTING.match(line):
            listing = []
            listings.append(listing)
            continue
        found = SHADER_DB.match(line)
        if found:
            name, stage = found.group(1), found.group(2)
            count, threads, _, uniforms, _, spills, fills = map(int, found.groups()[2:])
            fitting = [code for code in listings if len(code) == count]
            listings = []
            owner = re.match(r'GL(\d+)', name)
            program = programs.get(int(owner.group(1)) if owner else current)
            if program and 'VERT' not in stage and fitting:
                program.code = fitting[-1]
                program.inst, program.threads, program.uniforms = count, threads, uniforms
                program.spills, program.fills = spills, fills
            continue
        words = line.split()
        if line.startswith('RIG_FRAME'):
            frame = None if words[1] == 'end' else int(words[1])
        elif line.startswith('TRACE link'):
            current = int(words[2])
            defines = dict(w.split('=', 1) for w in words[4:])
            programs[current] = Program(words[3], defines)
        elif line.startswith('TRACE run'):
            current = int(words[2])
            if frame:
                runs.append((frame, current, tuple(map(int, words[3:6]))))
        elif line.startswith('TRACE cpu'):
            program = programs.get(int(words[2]))
            # Compiled at the link or at the first run; later runs take next to nothing.
            if program and program.cpu_ms < 1e5 and not linking.get(words[2], 0) > 1:
                program.cpu_ms += float(words[3])
                linking[words[2]] = linking.get(words[2], 0) + 1
    # The driver compiles the same source once.
    for program in programs.values():
        for other in programs.values():
            if program.code is None and other.code and (other.file, other.defines) == (program.file, program.defines):
                for field in ('code', 'inst', 'threads', 'uniforms', 'spills', 'fills'):
                    setattr(program, field, getattr(other, field))
    return programs, runs


def loops(code):
    """First and last instruction of every loop, by its backward branch and the three instructions behind it."""
    spans = {}
    for at, text in enumerate(code):
        branch = BRANCH.match(text)
        if branch:
            target = at + 4 + int(branch.group(1)) // 8
            if target <= at:
                spans[target] = max(spans.get(target, 0), at + 3)
    return sorted(spans.items())


def work(program, shape, groups):
    """How many batches of 16 lanes a run has, and how often each loop of the code turns, in the order of its addresses."""
    W, H, D, w, h = shape['W'], shape['H'], shape['D'], shape['w'], shape['h']
    fine, coarse = up(W, 4), up(w, 4)  # words of four pixels in a row
    defines, file = program.defines, program.file
    name = file.rsplit('.', 1)[0]
    along = defines.get('ALONG') == '1'
    steps = int(defines.get('STEPS', 16))
    slabs = int(defines.get('SLABS', 1))
    if file == 'rectify.frag':
        return up(shape['colour'], LANES), []
    if file.endswith('.frag'):
        return up(W * H, LANES), []
    table = {
        'stereo_luma': (up(fine + 2, LANES) * H, []),
        'exposure_gain': (4, [12, 12, 12]),
        'stereo_features': (up(fine, LANES) * up(H, 16), [0, 0] if defines.get('SHIFTED') == '1' else [0, up(16, int(defines.get('ROW_STEP', 1)))]),
        'stereo_clear': (1, []),
        'row_shift_votes': (up(up(W, 8), LANES) * up(H, 16), [up(D - 1, 4)]),
        'stereo_halve': (up(coarse + 2, LANES) * h * 2, []),
        'stereo_median_luma': (up(coarse + 2, LANES) * h * 2, []),
        'stereo_permeability': (up(coarse, LANES) * up(h, 4), [4]),
        'stereo_halved_cost': (prod(groups), [steps]),
        'stereo_halved_cost_narrow': (prod(groups),
                                      [LANES, up(4 * steps, LANES)]),
        'perm_cost': (prod(groups), []),
        'sgm_cost': (up(fine, LANES) * H * groups[2], []),
        'perm_weight': (up(coarse if along else h, LANES), [up(h, 4), h] if along else [coarse, coarse]),
        'perm_rows': (groups[0], [coarse, coarse]),
        'perm_columns': (groups[0], [up(h, 4)] * 2),
        'perm_columns_narrow': (groups[0], [up(h, 4)] * 2),
        'sgm_path': (groups[0], [h, h] if along else [w, w]),
        'sgm_path_narrow': (groups[0], [slabs, h if along else w, slabs] * 2),
        'left_right_check': (up(h, LANES), [coarse] * 2),
        'supported_disparity': (up(coarse, LANES) * up(h, 8), [8]),
        'supported_disparity_narrow': (up(coarse, LANES) * up(h, 8), [8, 5]),
        'row_fill': (up(h, LANES), [coarse, 0, coarse]),
        'disparity_smooth': (up(coarse, LANES) * up(h, 8), [8, 4] if along else [8]),
        'disparity_median': (up(coarse, LANES) * up(h, 8), [8]),
        'stereo_upsample': (up(coarse, LANES) * h, [2, 2]),
        'stereo_upsample_rows': (up(coarse, LANES) * h, []),
    }
    if name in table:
        return table[name]
    if name.startswith('path_fill'):
        # The passes over islands are in cells of one pixel where the grid is halved, else of two.
        cell = int(defines.get('CELL', 1 if h < H else 2))
        columns, rows = up(up(w, cell), 4), up(h, cell)
        return {
            'path_fill_cells': (up(columns, LANES) * rows, []),
            'path_fill_island_rows': (up(rows, LANES), [columns, columns]),
            'path_fill_island_columns': (up(columns, LANES), [rows, rows]),
            'path_fill_columns': (up(columns, LANES), [rows, rows]),
            'path_fill_rows': (up(rows, LANES), [columns] * 3 if 'LAST' in defines else [1, 0, columns, columns]),
            'path_fill_spread': (up(coarse, LANES) * h, []),
        }[name]
    if name == 'row_streaks':
        return up(coarse, LANES), None
    sys.exit(f'report.py: {file} is not in the table of work(): add its batches and loops')


def dynamic(program, trips, shape):
    """Instructions that a batch issues, and its TMU round trips, one after the other."""
    code, found = program.code, loops(program.code)
    weight = [1] * len(code)
    if trips is None:  # row_streaks: the walk down turns for every row, the judging of a streak hardly ever
        inner = [span for span in found if span != found[0]]
        for first, last in inner:
            for at in range(first, last + 1):
                weight[at] = shape['h'] if (first, last) == inner[0] else 0
    else:
        if len(found) != len(trips):
            sys.exit(f'report.py: {program.file} {program.label()} has {len(found)} loops in the compiler\'s code '
                     f'({found}) and {len(trips)} in the table of work(): correct the table')
        for (first, last), turns in zip(found, trips):
            for at in range(first, last + 1):
                weight[at] *= turns
    if program.file == 'rectify.frag':
        # Its longest branch is for pixels at the rim of the raw picture, and is not taken by others.
        jumps = [(at, at + 4 + int(b.group(1)) // 8) for at, b in enumerate(map(BRANCH.match, code)) if b]
        at, target = max(jumps, key=lambda jump: jump[1] - jump[0])
        for rare in range(at + 4, target):
            weight[rare] = 0
    return sum(weight), sum(weight[at] for at in waits(code))


def waits(code):
    """Thread switches behind which a result of the TMU is taken. The last switch of a program is signalled twice, and its end
    once more; nothing is waited for there."""
    switches = [at for at, text in enumerate(code) if 'thrsw' in text]
    for at, after in zip(switches, switches[1:] + [len(code) - 1]):
        if any('ldtmu' in text or 'tmuwt' in text for text in code[at + 1:after + 1]):
            yield at


PASS = {
    'camera_picture': 'camera', 'rectify': 'rectify', 'picture_reduce': 'reduce', 'stereo_luma': 'luma', 'exposure_gain': 'luma', 'stereo_features': 'census and gradient',
    'stereo_clear': 'row shift', 'row_shift_votes': 'row shift', 'stereo_halve': 'halve', 'stereo_median_luma': 'guide',
    'stereo_permeability': 'permeability', 'stereo_halved_cost': 'cost', 'stereo_halved_cost_narrow': 'cost', 'perm_cost': 'cost',
    'sgm_cost': 'cost', 'perm_weight': 'weights', 'perm_rows': 'cost and rows', 'perm_columns': 'columns and winners',
    'perm_columns_narrow': 'columns and winners', 'left_right_check': 'left-right check', 'supported_disparity': 'support',
    'supported_disparity_narrow': 'support', 'row_fill': 'fill', 'disparity_smooth': 'smooth', 'disparity_median': 'median',
    'row_streaks': 'streaks', 'stereo_upsample': 'upsample', 'stereo_upsample_rows': 'upsample', 'stereo_result': 'result', 'temporal_disparity': 'temporal',
}


def pass_of(program):
    name = program.file.rsplit('.', 1)[0]
    if name.startswith('sgm_path'):
        return 'column paths' if program.defines.get('ALONG') == '1' else 'row paths'
    if name == 'stereo_features' and program.defines.get('SHIFTED') == '1':
        return 'row shift'
    if name.startswith('path_fill'):
        return 'fill'
    return PASS[name]


def model(name, runs_folder):
    chip = CHIPS[name.split('_')[0][1:]]
    facts = json.loads((runs_folder / f'{name}.json').read_text())
    programs, runs = parse(runs_folder / f'{name}.err')
    half_width = facts['matcher'] == 'coarse'
    half_height = half_width or facts['matcher'] == 'row_pairs'
    W, H = facts['width_px'], facts['height_px']
    shape = dict(W=W, H=H, D=facts['disparities'], w=up(W, 2) if half_width else W, h=up(H, 2) if half_height else H,
                 colour=facts['colour_width_px'] * facts['colour_height_px'])
    frames = len({frame for frame, _, _ in runs})
    moved = {p['name']: p['bytes_moved'] for p in facts['passes']}
    rows, passes, longest_ms = {}, {}, 0.0
    for _, number, groups in runs:
        program = programs[number]
        if program.code is None:
            sys.exit(f'report.py: {name}: the driver showed no code of {program.file} {program.label()}')
        batches, trips = work(program, shape, groups)
        issued, trips_in_row = dynamic(program, trips, shape)
        row = rows.setdefault((program.file, program.label()),
                              dict(program=program, runs=0, lanes=0.0, issue_ms=0.0, round_trips=0.0, compile_ms=0.0))
        row['runs'] += 1 / frames
        row['lanes'] += batches * issued * LANES / frames
        issue_ms = up(batches, chip['qpus']) * issued * CYCLES_PER_BATCH / chip['hz'] * 1e3
        row['issue_ms'] += issue_ms / frames
        longest_ms = max(longest_ms, issue_ms)
        row['round_trips'] += up(batches, chip['qpus'] * min(program.threads, 4)) * trips_in_row / frames
    for program in programs.values():
        row = rows.get((program.file, program.label()))
        if row:
            row['compile_ms'] = max(row['compile_ms'], program.cpu_ms)
    for row in rows.values():
        cost = passes.setdefault(pass_of(row['program']), dict(issue_ms=0.0, lanes=0.0))
        cost['issue_ms'] += row['issue_ms']
        cost['lanes'] += row['lanes']
    bound = 0.0
    for pass_name, cost in passes.items():
        cost['bytes'] = moved.get(pass_name, 0)
        cost['memory_ms'] = cost['bytes'] / chip['bytes_per_s'] * 1e3
        cost['bound_ms'] = max(cost['issue_ms'], cost['memory_ms'])
        bound += cost['bound_ms']
    return dict(name=name, chip=chip, facts=facts, rows=rows, passes=passes, bound_ms=bound, longest_ms=longest_ms,
                lanes=sum(r['lanes'] for r in rows.values()), bytes=sum(p['bytes'] for p in passes.values()),
                round_trips=sum(r['round_trips'] for r in rows.values()),
                compile_ms=sum(r['compile_ms'] for r in rows.values()))


MALI_SHADER_DB = re.compile(r'^SHADER-DB: MESA_SHADER_(\w+) shader: (\d+) inst, .*, (\d+) threads, (\d+) loops, (\d+):(\d+) spills:fills')


def mali_programs(runs_folder):
    """Of a Mali-G610: programs by file and definitions, in the order of their compilation, with the presets that use each."""
    found = {}
    for path in sorted(runs_folder.glob('g610_*.err'), key=lambda path: ('fast', 'balanced', 'quality').index(path.stem[5:])):
        compiled, current, by_number = [], None, {}
        for line in path.read_text(errors='replace').splitlines():
            words = line.split()
            match = MALI_SHADER_DB.match(line)
            if match:
                # A drawing's vertex stages come first.
                if match.group(1) in ('FRAGMENT', 'COMPUTE'):
                    compiled.append(list(map(int, match.groups()[1:])))
            elif line.startswith('TRACE link'):
                current = int(words[2])
                by_number[current] = Program(words[3], dict(w.split('=', 1) for w in words[4:]))
            elif line.startswith('TRACE cpu') and compiled:
                # Compiled within a link, or within a run where the driver needs a variant.
                program = by_number[int(words[2])]
                row = found.setdefault((program.file, program.label()), dict(facts=compiled[-1], compile_ms=float(words[3]), presets=[]))
                if path.stem[5:] not in row['presets']:
                    row['presets'].append(path.stem[5:])
                compiled = []
    return found


def mali_section(programs):
    out = ['## Mali-G610 (RK3588)', '',
           'Panfrost, the driver of the Mali-G610 in an RK3588, compiles the same programs on a pretended device. Invocations lie along disparities, as on',
           'V3D. The table has no times: the driver prints the instructions of a program, and not what its loops make of them.',
           '*Threads* is 2 where a core keeps all of its threads, and 1 where the program\'s registers halve them. The search is 640x400 with 64 disparities.', '',
           '| program | definitions | presets | instructions | threads | spills:fills | loops | compile, ms |',
           '| --- | --- | --- | --- | --- | --- | --- | --- |']
    for (file, label), row in programs.items():
        count, threads, loop_count, spills, fills = row['facts']
        out.append(f"| {file} | {label} | {', '.join(row['presets'])} | {count} | {threads} | {spills}:{fills} | {loop_count} | {row['compile_ms']:.0f} |")
    return out + ['']


def title(m):
    f = m['facts']
    of_yuyv = ', YUYV' if f.get('format') == 'YUYV' else ''
    of_larger = f" of {f['colour_width_px']}x{f['colour_height_px']}" if f['colour_width_px'] != f['width_px'] else ''
    return f"{f['preset']} ({f['matcher']}) {f['width_px']}x{f['height_px']}x{f['disparities']}{of_larger}{of_yuyv}"


def document(models, mali, mesa):
    out = ['# Raspberry Pi\'s GPU', '',
           'This page says how much GPU time a rig\'s frame takes at least on a Raspberry Pi 5 and 4, for each preset and size. Its end has what the',
           'compiler of another board\'s GPU makes of the programs.',
           '[Hardware](../build/hardware.md#which-preset) says which preset to choose.', '',
           '```text', 'tools/v3d.sh', '```', '',
           f'The command writes this page. It runs the GPU work of a rig\'s frame on Mesa {mesa}\'s V3D driver and a pretended GPU.',
           'The work is rectification of NV12 or YUYV, matching of a stream, and the temporal filter. Where a row says *of 960x720*, rectified pictures of that size',
           'are reduced before they are matched. Programs are compiled for the real instruction set.',
           'Nothing executes, and no number here was measured on a Raspberry Pi.', '',
           '**Every time is a lower bound.** A pass takes at least the longer of two times. One is the time to issue the instructions that the',
           'compiler emitted, with the loops\' real trip counts, on the QPUs that the pass fills. The other is the time to move the bytes that',
           'the pass reads and writes, each counted once. Texture latency, cache misses, the read-back and the processor\'s part are not in it.',
           'The *longest run* is that of one program without a break; the kernel of a Raspberry Pi ends runs of 500 ms.',
           'A *round trip* is a wait for the texture and memory unit that cannot overlap with another one of the same lane.', '',
           '## Totals', '',
           '| GPU | preset, size | lower bound, ms | M lane instructions | MB per frame | round trips, thousands | longest run, ms | compile time of all programs, s |',
           '| --- | --- | --- | --- | --- | --- | --- | --- |']
    for m in models:
        out.append(f"| {m['chip']['name']} | {title(m)} | {m['bound_ms']:.1f} | {m['lanes'] / 1e6:.0f} | {m['bytes'] / 1e6:.0f} | "
                   f"{m['round_trips'] / 1e3:.0f} | {m['longest_ms']:.1f} | {m['compile_ms'] / 1e3:.1f} |")
    out += ['', 'Assumed memory rate, processors and clock: ' + '; '.join(f"{c['name']} {c['bytes_per_s'] / 1e9:.1f} GB/s, {c['qpus']} QPUs at {c['hz'] / 1e6:.0f} MHz"
                                                  for c in CHIPS.values()) + '.', '']
    for m in models:
        out += [f"## {m['chip']['name']}, {title(m)}", '',
                '| program | definitions | instructions | threads | spills:fills | uniforms | compile, ms | runs | M lane instructions | issue, ms | round trips |',
                '| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |']
        for row in m['rows'].values():
            p = row['program']
            out.append(f"| {p.file} | {p.label()} | {p.inst} | {p.threads} | {p.spills}:{p.fills} | {p.uniforms} | {row['compile_ms']:.0f} | "
                       f"{row['runs']:.3g} | {row['lanes'] / 1e6:.1f} | {row['issue_ms']:.2f} | {row['round_trips']:.0f} |")
        out += ['', '| pass | issue, ms | MB | memory, ms | bound, ms |', '| --- | --- | --- | --- | --- |']
        for name, cost in m['passes'].items():
            out.append(f"| {name} | {cost['issue_ms']:.2f} | {cost['bytes'] / 1e6:.1f} | {cost['memory_ms']:.2f} | {cost['bound_ms']:.2f} |")
        out.append('')
    return '\n'.join(out + mali_section(mali))


def faults(models, mali, previous):
    """Sentences about what exceeds a limit."""
    known = {}
    for line in previous.splitlines():
        cells = [c.strip() for c in line.split('|')[1:-1]]
        if len(cells) == 8 and re.fullmatch(r'[0-9.]+', cells[2]):
            known[cells[0], cells[1]] = float(cells[2])
    for (file, label), row in mali.items():
        what = f'Mali-G610: {file} {label}'.rstrip()
        if row['facts'][3] > LIMITS['mali_spills']:
            yield f"{what} spills {row['facts'][3]} registers, more than {LIMITS['mali_spills']}: give a lane less to hold"
        if row['compile_ms'] > LIMITS['compile_ms']:
            yield f"{what} takes {row['compile_ms'] / 1e3:.1f} s to compile, more than {LIMITS['compile_ms'] / 1e3:.0f} s: unroll less"
    for m in models:
        where = f"{m['chip']['name']}, {title(m)}"
        for row in m['rows'].values():
            p = row['program']
            what = f'{where}: {p.file} {p.label()}'.rstrip()
            if p.spills > LIMITS['spills']:
                yield f"{what} spills {p.spills} registers: give a lane less to hold"
            if row['compile_ms'] > LIMITS['compile_ms']:
                yield f"{what} takes {row['compile_ms'] / 1e3:.1f} s to compile, more than {LIMITS['compile_ms'] / 1e3:.0f} s: unroll less"
            if p.threads < LIMITS['threads']:
                yield f"{what} runs with {p.threads} thread: give a lane less to hold"
        if m['longest_ms'] > LIMITS['dispatch_ms']:
            yield f"{where}: a program runs for {m['longest_ms']:.0f} ms at a time, more than {LIMITS['dispatch_ms']} ms: divide it with dispatch_in_parts()"
        before = known.get((m['chip']['name'], title(m)))
        if before is None:
            yield f'{where} is not in the page: write it anew with tools/v3d.sh'
        elif m['bound_ms'] > before * LIMITS['growth']:
            yield f"{where}: the lower bound is {m['bound_ms']:.1f} ms, and the page says {before:.1f} ms: find the pass that grew, or write the page anew"


def main():
    arguments = [a for a in sys.argv[1:] if a != '--check']
    folder, page = Path(arguments[0]), Path(arguments[1])
    mesa = (folder / 'mesa_version').read_text().strip()
    order = {'fast': 0, 'balanced': 1, 'quality': 2}
    models = [model(path.stem, folder) for path in folder.glob('v*.json')]
    models.sort(key=lambda m: (-m['chip']['qpus'], m['facts']['width_px'], order[m['facts']['preset']], m['name']))
    (folder / 'models.json').write_text(json.dumps(
        [dict(name=m['name'], bound_ms=m['bound_ms'], passes=m['passes']) for m in models], indent=1))
    mali = mali_programs(folder)
    if '--check' not in sys.argv:
        page.write_text(document(models, mali, mesa))
        for m in models:
            print(f"{m['chip']['name']}, {title(m)}: {m['bound_ms']:.1f} ms at least")
    found = list(faults(models, mali, page.read_text()))
    for sentence in found:
        print(sentence, file=sys.stderr)
    sys.exit(1 if found else 0)


main()
