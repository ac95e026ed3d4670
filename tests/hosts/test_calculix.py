"""CalculiX with libSTICKSLIP.so: the decks in examples/calculix against `friction_update` and the program.

STICKSLIP_LIBRARY, STICKSLIP_CALCULIX: the shared libraries; STICKSLIP: the program; CCX: CalculiX with support
for external behaviours. A picture of the slider, laid beside the program's own curve, is left where the test runs.
"""
import csv
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

import friction_point  # noqa: E402

EXAMPLES = HERE.parents[1] / 'examples/calculix'
CCX = os.environ.get('CCX', '')
HEADING = re.compile(r' (\S.*?) (?:\(|for set).*time +(\S+)')


def run_deck(name, folder):
    """Runs a deck of examples/calculix; gives its tables [(title, time, rows)]."""
    deck = folder / f'{name}.inp'
    shutil.copy(EXAMPLES / deck.name, deck)
    library = pathlib.Path(os.environ['STICKSLIP_CALCULIX']).parent
    result = subprocess.run([CCX, name], cwd=folder, text=True, capture_output=True, check=False,
                            env={**os.environ, 'LD_LIBRARY_PATH': str(library), 'OMP_NUM_THREADS': '1'})
    if 'Job finished' not in result.stdout:
        raise AssertionError(result.stdout[-2000:])
    tables = []
    for line in (folder / f'{name}.dat').read_text().splitlines():
        heading = HEADING.match(line)
        if heading:
            tables.append((heading.group(1), float(heading.group(2)), []))
        elif line.strip():
            tables[-1][2].append([float(word) for word in line.split()])
    return tables


def iterations(folder, name):
    """Iterations of each increment, from the .sta file."""
    rows = [line.split() for line in (folder / f'{name}.sta').read_text().splitlines()]
    return [int(row[3]) for row in rows if len(row) == 7 and row[0].isdigit()]


@unittest.skipUnless(os.path.exists(CCX), 'no CalculiX with external behaviours: ./dev hosts builds it')
class CalculiX(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def test_block_on_block_pressed_sheared_and_reversed(self):
        tables = run_deck('block_on_block', self.folder)
        thickness, friction = 0.1, [1, 1000, 800, 0.45, 0.25, 8, 0.2, 60]
        pressure = 10 / 3   # 1 mm^2 pressed by 0.004 mm through springs of 1000 and twice 10000 N/mm
        points = {}
        time = worst = worst_state = worst_force = 0.0
        slipping = sticking = 0
        for at in range(0, len(tables), 4):
            stresses, strains, states, forces = (table[2] for table in tables[at:at + 4])
            dt, time = tables[at][1] - time, tables[at][1]
            force = [0.0, 0.0, 0.0]
            for stress, strain, state in zip(stresses, strains, states):
                point, old = points.setdefault(int(stress[1]), (friction_point.FrictionPoint(friction), [0.0] * 3))
                gap = [thickness * strain[4], 2 * thickness * strain[6], 2 * thickness * strain[7]]
                traction = point.update([new - before for new, before in zip(gap, old)], dt)
                points[int(stress[1])] = (point, gap)
                found = [stress[4], stress[6], stress[7]]
                worst = max(worst, *(abs(a - b) / pressure for a, b in zip(found, traction)))
                worst_state = max(worst_state, *(abs(a - b) for a, b in zip(state[6:8], point.statev[4:6])))
                force = [total + part / 8 for total, part in zip(force, [*traction[1:], traction[0]])]
                if time > 0.055:
                    slipping += state[2] == 2
                    sticking += state[2] == 1
            worst_force = max(worst_force, *(abs(a - b) / pressure for a, b in zip(forces[0], force)))
        most = max(iterations(self.folder, 'block_on_block'))
        print(f'\n  block on block: worst difference {worst:.1e} of the pressure in the stress, '
              f'{worst_force:.1e} in the reaction, {worst_state:.1e} in mu and R; most iterations {most}; '
              f'{slipping // 8} increments slip, {sticking // 8} stick')
        # the output has seven digits, and the path is the sum of 75 rounded increments
        self.assertLess(worst, 1e-5)
        self.assertLess(worst_force, 1e-5)
        self.assertLess(worst_state, 1e-4)
        self.assertLessEqual(most, 4)
        self.assertGreater(slipping // 8, 40)
        self.assertGreater(sticking // 8, 5)

    def test_slider_sticks_and_slips_like_the_program(self):
        tables = run_deck('slider', self.folder)
        found = {round(1e3 * (time - 1e-6)): rows[0][1] for title, time, rows in tables
                 if title == 'displacements'}
        (self.folder / 'slider.nml').write_text("""
            &friction law='subloading', alpha_n=1000, alpha_t=1000, mu_s=0.4, mu_k=0.2, kappa=10, xi=10, m=1000 /
            &slider mass=1e-3, stiffness=1, normal_traction=10 /
            &drive velocity=1 /
            &time t_end=8, dt=1e-3 /""")
        subprocess.run([os.environ['STICKSLIP'], 'run', 'slider.nml', '--no-plot', '--quiet'], cwd=self.folder,
                       check=True)
        with open(self.folder / 'slider_out/slider.csv', newline='', encoding='utf-8') as file:
            own = {round(1e3 * float(row['time'])): float(row['displacement']) for row in csv.DictReader(file)}
        self.assertEqual(len(found), 8000)
        worst = max(abs(found[step] - own[step]) for step in found)
        print(f'\n  slider: slips {own[5000]:.3f} mm at 4 s; worst difference over 8000 steps {worst:.1e} mm')
        self.assertGreater(own[5000], 3.0)
        self.draw(found, own)
        # both solve the same equations; what differs is their tolerance, seen through two slip events
        self.assertLess(worst, 1e-4)

    def draw(self, found, own):
        with open('calculix_slider.dat', 'w', encoding='utf-8') as file:
            file.writelines(f'{step / 1e3} {found[step]} {own[step]}\n' for step in sorted(found))
        if shutil.which('gnuplot') is None:
            return
        commands = """set terminal pngcairo size 1000,500
            set output 'calculix_slider.png'
            set xlabel 'time [s]'
            set ylabel 'spring force [N]'
            set grid
            plot 'calculix_slider.dat' using 1:($1-$3) with lines linewidth 4 linecolor 'gray70' title 'stickslip', \
                 '' using 1:($1-$2) with lines linewidth 1 linecolor 'black' title 'CalculiX'"""
        subprocess.run(['gnuplot'], input=commands, text=True, check=True)


if __name__ == '__main__':
    unittest.main()
