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
    events, series = run(program, 'fault_bp1.nml', {'nz = 512': 'nz = 1600', 't_end = 1.26144e10': 't_end = 3.2e10'})
    for i, onset in enumerate((196.49, 272.159, 350.023)):
        report.row(f'BP1: onset of event {i + 1}', HBI, onset, events['onset'][i] / YEAR, 0.05, absolute=True)
    report.row('BP1: steady recurrence, years', 'trial code, 25 m', 78.40, numpy.diff(events['onset'])[-1] / YEAR, 0.03,
               absolute=True)
    report.row('BP1: peak slip rate of the last event, m/s', HBI, 4.18, events['peak_slip_rate'][-1], 0.03, absolute=True)
    report.row('BP1: slip at the surface in the last event, m', HBI, 2.472, events['largest_slip'][-1], 0.005, absolute=True)
    report.row('BP1: what the balance of energy is open by', 'none', 0, open_by(series), 1e-6, absolute=True)
    cell_sizes(program, report)
    events, _ = run(program, 'fault_bp2.nml', {'nz = 800': 'nz = 1600'})
    for i, (onset, rate) in enumerate(((151.34, 0.67), (209.09, 5.43), (233.26, 0.58))):
        report.row(f'BP2: onset of event {i + 1}', 'trial code, 25 m', onset, events['onset'][i] / YEAR, 0.05, absolute=True)
        report.row('BP2: its peak slip rate, m/s', 'trial code, 25 m', rate, events['peak_slip_rate'][i], 0.02, absolute=True)
    tolerances(program, report)
    subloading(program, report)
    compare_laws(program, report)


def open_by(series):
    """The energy that is missing at the end, over the work of loading."""
    loading, elastic, dissipated, radiated = (series[name][-1] for name in (
        'loading_work', 'elastic_energy', 'dissipated', 'radiated'))
    return abs(loading - elastic - dissipated - radiated) / loading


def cell_sizes(program, report):
    """The steady recurrence of BP1 with cells of half the size, and of half of that: its error falls with their square."""
    recurrences = []
    for nz in (256, 512, 1024):
        events, _ = run(program, 'fault_bp1.nml', {'nz = 512': f'nz = {nz}', 't_end = 1.26144e10': 't_end = 2.7e10'})
        recurrences.append(numpy.diff(events['onset'])[-1] / YEAR)
    coarse, fine = numpy.diff(recurrences)
    report.row('BP1: order of the recurrence in cell size, 156, 78, 39 m', 'kernel of constant slip', 2,
               numpy.log2(coarse / fine), 0.7, absolute=True)


def tolerances(program, report):
    """How the third onset of BP1 at 156 m follows rtol."""
    onsets = {}
    for rtol in ('1e-3', '1e-4', '1e-5', '1e-7'):
        events, _ = run(program, 'fault_bp1.nml', {'nz = 512': 'nz = 256', 'rtol = 1e-4': f'rtol = {rtol}'})
        onsets[rtol] = events['onset'][2] / YEAR
    for rtol, allowed in (('1e-3', 0.05), ('1e-4', 0.02), ('1e-5', 0.005)):
        report.row(f'BP1 at 156 m: onset of event 3 with rtol = {rtol}', 'rtol = 1e-7', onsets['1e-7'], onsets[rtol], allowed,
                   absolute=True)


def subloading(program, report):
    """The subloading law: the first event of a trial code, and what cells and rtol do to the next ones."""
    events, _ = run(program, 'fault_subloading.nml', {'xi = 3e-10': 'xi = 1e-9', 't_end = 1.8922e10': 't_end = 1.45e10'})
    report.row('subloading, healing in 30 years, 156 m: onset of event 1', 'trial code, other steps', 454.2,
               events['onset'][0] / YEAR, 0.2, absolute=True)
    report.row('subloading, healing in 30 years, 156 m: its peak slip rate, m/s', 'trial code, other steps', 0.82,
               events['peak_slip_rate'][0], 0.02, absolute=True)
    onsets = {}
    for nz, rtol in ((256, '1e-3'), (256, '1e-5'), (512, '1e-3'), (1024, '1e-3')):
        events, series = run(program, 'fault_subloading.nml', {'nz = 256': f'nz = {nz}', 'rtol = 1e-3': f'rtol = {rtol}',
                                                               't_end = 1.8922e10': 't_end = 1.58e10'})
        onsets[nz, rtol] = events['onset'] / YEAR
    report.row('subloading: what the balance of energy is open by', 'none', 0, open_by(series), 1e-5, absolute=True)
    for i in (1, 2):
        report.row(f'subloading, 156 m: onset of event {i + 1} with rtol = 1e-3', 'rtol = 1e-5', onsets[256, '1e-5'][i],
                   onsets[256, '1e-3'][i], 0.01, absolute=True)
        report.row(f'subloading: onset of event {i + 1} at 78 m', '39 m', onsets[1024, '1e-3'][i], onsets[512, '1e-3'][i], 0.3,
                   absolute=True)
    report.row('subloading: recurrence at 78 m, years', '39 m', onsets[1024, '1e-3'][2] - onsets[1024, '1e-3'][1],
               onsets[512, '1e-3'][2] - onsets[512, '1e-3'][1], 0.02, absolute=True)


def compare_laws(program, report):
    figure, axis = plot.subplots(figsize=(9, 4))
    for name, label in (('fault_bp1.nml', 'rate-and-state'), ('fault_subloading.nml', 'subloading')):
        _, series = run(program, name, {})
        axis.plot(series['time'] / YEAR, series['log10_slip_rate'], label=label)
    axis.set_ylim(-14, 2)   # a fault at rest has no logarithm
    axis.set_xlabel('time [years]')
    axis.set_ylabel('log10 of the largest slip rate [m/s]')
    axis.legend()
    report.picture(figure, 'fault', 'One fault under two laws')
