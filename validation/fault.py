"""Earthquakes on a fault: benchmarks BP1 and BP2 of the SEAS project, and what law and errors do to them."""
import pathlib
import subprocess
import tempfile

import matplotlib.pyplot as plot
import numpy

from program import table

YEAR = 365 * 86400
INPUTS = pathlib.Path(__file__).resolve().parent.parent / 'inputs'
HBI = 'HBI (boundary elements), 25 m'
INTRODUCTION = """
Inputs `fault_bp1.nml` and `fault_bp2.nml` at 25 m cells, `rtol = 1e-4`, against published codes at the same resolution, and the
recurrence that the community's codes converge to. Times are in years of 365 days; the benchmark's own codes differ by hundredths of them.
"""


def run(program, name, changes):
    """Events, and the global series, of an input with some of its texts changed."""
    with tempfile.TemporaryDirectory() as folder:
        for path in INPUTS.glob('*.csv'):
            pathlib.Path(folder, path.name).write_text(path.read_text())
        text = (INPUTS / name).read_text()
        for old, new in changes.items():
            if old not in text:
                raise RuntimeError(f'{name} has no {old}')
            text = text.replace(old, new)
        pathlib.Path(folder, 'case.nml').write_text(text)
        result = subprocess.run([program.path, 'fault', 'case.nml', '--no-plot', '--quiet'], cwd=folder, text=True,
                                capture_output=True, check=False)
        if result.returncode:
            raise RuntimeError(result.stderr)
        return table(f'{folder}/case_out/case_events.csv'), table(f'{folder}/case_out/case_global.csv')


def validate(program, report):
    report.section('Earthquakes on a fault', INTRODUCTION)
    if not pathlib.Path(program.path).with_name('stickslip-fault').exists():
        report.skip('BP1: onset of the first event', HBI, 196.49, 'built without FFTW')
        return
    events, _ = run(program, 'fault_bp1.nml', {'nz = 512': 'nz = 1600'})
    for i, onset in enumerate((196.49, 272.159, 350.023)):
        report.row(f'BP1: onset of event {i + 1}', HBI, onset, events['onset'][i] / YEAR, 0.05, absolute=True)
    report.row('BP1: peak slip rate of event 3, m/s', HBI, 4.18, events['peak_slip_rate'][2], 0.03, absolute=True)
    report.row('BP1: largest slip of event 3, m', HBI, 2.472, events['largest_slip'][2], 0.005, absolute=True)
    events, _ = run(program, 'fault_bp1.nml', {'t_end = 1.26144e10': 't_end = 3.4e10'})
    report.row('BP1 at 78 m: steady recurrence, years', 'trial code, 78 m', 78.388,
               numpy.diff(events['onset'])[-1] / YEAR, 0.1, absolute=True)
    events, _ = run(program, 'fault_bp2.nml', {'nz = 800': 'nz = 1600'})
    for i, (onset, rate) in enumerate(((151.34, 0.67), (209.09, 5.43), (233.26, 0.58))):
        report.row(f'BP2: onset of event {i + 1}', 'trial code, 25 m', onset, events['onset'][i] / YEAR, 0.05, absolute=True)
        report.row('BP2: its peak slip rate, m/s', 'trial code, 25 m', rate, events['peak_slip_rate'][i], 0.02, absolute=True)
    tolerances(program, report)
    compare_laws(program, report)


def tolerances(program, report):
    """How the third onset of BP1 at 156 m follows rtol."""
    onsets = {}
    for rtol in ('1e-3', '1e-4', '1e-5', '1e-7'):
        events, _ = run(program, 'fault_bp1.nml', {'nz = 512': 'nz = 256', 'rtol = 1e-4': f'rtol = {rtol}'})
        onsets[rtol] = events['onset'][2] / YEAR
    for rtol, allowed in (('1e-3', 0.05), ('1e-4', 0.02), ('1e-5', 0.005)):
        report.row(f'BP1 at 156 m: onset of event 3 with rtol = {rtol}', 'rtol = 1e-7', onsets['1e-7'], onsets[rtol], allowed,
                   absolute=True)


def compare_laws(program, report):
    figure, axis = plot.subplots(figsize=(9, 4))
    for name, label in (('fault_bp1.nml', 'rate-and-state'), ('fault_subloading.nml', 'subloading')):
        events, series = run(program, name, {})
        axis.plot(series['time'] / YEAR, series['log10_slip_rate'], label=label)
        if label == 'subloading':
            report.row('subloading, 156 m: onset of event 1', 'trial code, other steps', 454.2, events['onset'][0] / YEAR, 0.2,
                       absolute=True)
            report.row('subloading, 156 m: its peak slip rate, m/s', 'trial code, other steps', 0.82,
                       events['peak_slip_rate'][0], 0.02, absolute=True)
    axis.set_ylim(-14, 2)   # a fault at rest has no logarithm
    axis.set_xlabel('time [years]')
    axis.set_ylabel('log10 of the largest slip rate [m/s]')
    axis.legend()
    report.picture(figure, 'fault', 'One fault under two laws')
