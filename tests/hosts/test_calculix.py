"""CalculiX with libSTICKSLIP.so: the decks in examples/calculix against `friction_update` and the program.

STICKSLIP_LIBRARY, STICKSLIP_CALCULIX: the shared libraries; STICKSLIP: the program; CCX: CalculiX with support
for external behaviours. A picture of the slider, laid beside the program's own curve, is left where the test runs.
"""
import csv
import itertools
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import friction_point  # noqa: E402
import layer_deck  # noqa: E402
from worst_errors import worst_of  # noqa: E402

EXAMPLES = HERE.parents[1] / 'examples/calculix'
CCX = os.environ.get('CCX', '')
HEADING = re.compile(r' (\S.*?) (?:\(|for set).*time +(\S+)')


NUMBER = r'-?\d+(?:\.\d*)?(?:E[-+]\d+)?'


MATERIAL = re.compile(r'\*USER MATERIAL.*?(?=\*DEPVAR)', re.DOTALL)
LAYER = [0.1, 1.0]   # thickness and in-plane modulus in the decks


def material(constants, layer=None):
    """The lines of a user material: eight constants a line, and behind them, on a new line after eight, a temperature."""
    words = [repr(float(constant)) for constant in (layer or LAYER) + constants]
    lines = [', '.join(words[at:at + 8]) for at in range(0, len(words), 8)]
    if len(words) % 8 == 0:
        lines.append('0.')
    return '\n'.join([f'*USER MATERIAL, CONSTANTS={len(words)}', *lines, ''])


def run_deck(name, folder, friction, change=lambda text: text):
    """Runs a deck of examples/calculix under a law; gives its tables [(title, time, rows)]."""
    deck = (EXAMPLES / f'{name}.inp').read_text()
    return run_text(change(MATERIAL.sub(material(friction), deck)), folder, name)


def solve(deck, folder, name):
    """Runs a deck; gives what it printed into its .dat file."""
    (folder / f'{name}.inp').write_text(deck)
    library = pathlib.Path(os.environ['STICKSLIP_CALCULIX']).parent
    result = subprocess.run([CCX, name], cwd=folder, text=True, capture_output=True, check=False,
                            env={**os.environ, 'LD_LIBRARY_PATH': str(library), 'OMP_NUM_THREADS': '1'})
    if 'Job finished' not in result.stdout:
        raise AssertionError(result.stdout[-2000:])
    return (folder / f'{name}.dat').read_text()


def run_text(deck, folder, name):
    """Runs a deck; gives its tables [(title, time, rows)]."""
    tables = []
    for line in solve(deck, folder, name).splitlines():
        heading = HEADING.match(line)
        if heading:
            tables.append((heading.group(1), float(heading.group(2)), []))
        elif line.strip():
            tables[-1][2].append([float(word) for word in re.findall(NUMBER, line)])
    return tables


def positions(tables):
    """Displacements of the slider by step, of 1 ms after the first instant that presses it on the base."""
    return {round(1e3 * (time - 1e-6)): rows[0][1] for title, time, rows in tables if title == 'displacements'}


def iterations(folder, name):
    """Iterations of each increment, from the .sta file."""
    rows = [line.split() for line in (folder / f'{name}.sta').read_text().splitlines()]
    return [int(row[3]) for row in rows if len(row) == 7 and row[0].isdigit()]


@unittest.skipUnless(os.path.exists(CCX), 'no CalculiX with external behaviours: ./dev hosts builds it')
class CalculiX(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)

    def test_block_on_block_pressed_sheared_and_reversed_under_every_law(self):
        for name, friction in friction_point.LAWS.items():
            with self.subTest(law=name):
                self.compare_block(name, friction)

    def test_the_example_s_own_constants_are_these(self):
        lines = MATERIAL.search((EXAMPLES / 'block_on_block.inp').read_text()).group().split('\n')
        own = [float(word) for line in lines[1:] for word in line.split(',') if word.strip()]
        self.assertEqual(own, LAYER + friction_point.LAWS['subloading'])

    def test_cohesion_and_damper_follow_their_closed_form(self):
        name = friction_point.WITH_OPTIONS
        self.compare_block(name, friction_point.LAWS[name], friction_point.CoulombPoint)

    def compare_block(self, name, friction, new_point=friction_point.FrictionPoint):
        tables = run_deck('block_on_block', self.folder, friction)
        thickness = LAYER[0]
        pressure = 10 / 3   # 1 mm^2 pressed by 0.004 mm through springs of 1000 and twice 10000 N/mm
        points = {}
        time = worst = worst_state = worst_force = 0.0
        slipping = sticking = 0
        for at in range(0, len(tables), 4):
            stresses, strains, states, forces = (table[2] for table in tables[at:at + 4])
            dt, time = tables[at][1] - time, tables[at][1]
            force = [0.0, 0.0, 0.0]
            for stress, strain, state in zip(stresses, strains, states):
                point, old = points.setdefault(int(stress[1]), (new_point(friction), [0.0] * 3))
                gap = [thickness * strain[4], 2 * thickness * strain[6], 2 * thickness * strain[7]]
                traction = point.update([new - before for new, before in zip(gap, old)], dt)
                points[int(stress[1])] = (point, gap)
                found = [stress[4], stress[6], stress[7]]
                worst = worst_of([worst, *(abs(a - b) / pressure for a, b in zip(found, traction))])
                worst_state = worst_of([worst_state, *(abs(a - b) for a, b in zip(state[6:10], point.statev[4:8]))])
                force = [total + part / 8 for total, part in zip(force, [*traction[1:], traction[0]])]
                if time > 0.055:
                    slipping += state[2] == 2
                    sticking += state[2] == 1
            worst_force = worst_of([worst_force, *(abs(a - b) / pressure for a, b in zip(forces[0], force))])
        most = max(iterations(self.folder, 'block_on_block'))
        print(f'\n  block on block, {name}: worst difference {worst:.1e} of the pressure in the stress, '
              f'{worst_force:.1e} in the reaction, {worst_state:.1e} in mu, R, slip and dissipation; most iterations {most}; '
              f'{slipping // 8} increments slip, {sticking // 8} stick')
        # the output has seven digits, and the path is the sum of 75 rounded increments
        self.assertLess(worst, 1e-5)
        self.assertLess(worst_force, 1e-5)
        self.assertLess(worst_state, 1e-5)
        self.assertLessEqual(most, 4)
        self.assertGreater(slipping // 8, 20)
        if name not in friction_point.CREEPING:
            self.assertGreater(sticking // 8, 5)

    def test_many_elements_follow_friction_update_under_every_law(self):
        """10 x 10 elements between two elastic blocks, pressed unevenly, sheared, reversed."""
        for name in ('subloading', 'rate_and_state'):
            with self.subTest(law=name):
                friction = friction_point.LAWS[name]
                deck = layer_deck.deck(10, LAYER, material(friction), layer_deck.PRESSED + layer_deck.SHEARED)
                tables = run_text(deck, self.folder, 'many')
                worst, slipping = self.replay(tables, friction)
                counts = iterations(self.folder, 'many')
                print(f'\n  CalculiX, 100 elements in the layer, {name}: {len(counts)} increments, iterations at most '
                      f'{max(counts)}, mean {sum(counts) / len(counts):.2f}; worst difference {worst:.1e} of the pressure; '
                      f'slip in {slipping:.0%}')
                self.assertLess(worst, 1e-5)
                self.assertGreater(slipping, 0.2)

    def replay(self, tables, friction):
        """Worst difference of the stress from friction_update along the strains, and the share of points that slip."""
        points, time, worst, slips, count, pressure = {}, 0.0, 0.0, 0, 0, 0.0
        for at in range(0, len(tables), 3):
            stresses, strains, states = (table[2] for table in tables[at:at + 3])
            dt, time = tables[at][1] - time, tables[at][1]
            for stress, strain, state in zip(stresses, strains, states):
                key = (int(stress[0]), int(stress[1]))
                point, old = points.setdefault(key, (friction_point.FrictionPoint(friction), [0.0] * 3))
                gap = [LAYER[0] * strain[4], 2 * LAYER[0] * strain[6], 2 * LAYER[0] * strain[7]]
                traction = point.update([new - before for new, before in zip(gap, old)], dt)
                points[key] = (point, gap)
                pressure = max(pressure, abs(traction[0]))
                worst = worst_of([worst, *(abs(a - b) for a, b in zip([stress[4], stress[6], stress[7]], traction))])
                slips += state[2] == 2
                count += 1
        return worst / pressure, slips / count

    def test_a_force_presses_bodies_that_just_touch(self):
        for option, idle in itertools.product(('', ', NLGEOM'), (False, True)):
            step = f'*STEP{option}\n*STATIC\n0.5, 1.\n*CLOAD\nTOP, 3, {{}}\n{layer_deck.PRINT}*END STEP\n'
            steps = (step.format(0.0) if idle else '') + step.format(-100.0)   # at four nodes of 20 mm by 20 mm
            tables = run_text(layer_deck.deck(1, LAYER, material(friction_point.LAWS['subloading']), steps), self.folder, 'pressed')
            stresses = [rows[4] for rows in tables[-3][2]]
            self.assertLess(worst_of(abs(stress + 1) for stress in stresses), 1e-3, (option, idle))
            self.assertLessEqual(max(iterations(self.folder, 'pressed')), 4)

    def test_a_long_slip_under_nlgeom_keeps_its_pressure(self):
        """0.05 mm over layers of 0.1 and of 1 mm: the forces of small displacements, to what else NLGEOM changes."""
        for thickness in (0.1, 1.0):
            forces = {}
            for option in ('', ', NLGEOM'):
                layer = [thickness, 1.0]
                deck = layer_deck.deck(2, layer, material([2, 1000, 800, 0.4], layer),
                                       layer_deck.dragged(option, 0.05), length=2.0, height=1.0, young=1e5, poisson=0.0)
                forces[option] = run_text(deck, self.folder, 'slide')[-1][2][-1][-3:]
            print(f'\n  slip of 0.05 mm over a layer of {thickness} mm: shear and normal force {forces[""][0]:.4f}, '
                  f'{forces[""][2]:.4f} N; under NLGEOM {forces[", NLGEOM"][0]:.4f}, {forces[", NLGEOM"][2]:.4f} N')
            self.assertAlmostEqual(forces[''][0], 4.706, delta=1e-3)
            self.assertAlmostEqual(forces[''][2], -11.765, delta=1e-3)
            for found, expected in zip(forces[', NLGEOM'], forces['']):
                self.assertAlmostEqual(found, expected, delta=1e-3 * 11.765)

    def test_frequencies_after_slip_are_those_of_the_contact_springs(self):
        """In a perturbation step the layer is elastic, whatever slid before; a layer of an elastic material is the
        reference. CalculiX adds what the pressed and sheared state does to the stiffness."""
        def with_density(deck):
            return re.sub(r'(\*ELASTIC\n.*\n|(?=\*DEPVAR))', r'\1*DENSITY\n7.8E-9\n', deck)

        def frequencies(deck, name):
            rows = solve(deck, self.folder, name).split('E I G E N V A L U E   O U T P U T')[1].splitlines()
            return [float(row.split()[3]) for row in rows if re.match(r' +[1-4] +\S+ +\S+ +\S+ +\S+$', row)]

        deck = with_density((EXAMPLES / 'block_on_block.inp').read_text())
        layer = '*ELASTIC, TYPE=ORTHO\n1., 0., 1., 0., 0., 100., .5, 80.,\n80.\n'
        elastic = re.sub(r'\*USER MATERIAL.*?(?=\*DENSITY)', layer, deck[:deck.index('*STEP')], flags=re.DOTALL)
        elastic = re.sub(r'\*DEPVAR\n8\n', '', elastic).replace('@ABAQUS_STICKSLIP', 'SPRINGS')
        frequency = '*FREQUENCY\n4\n'
        wanted = frequencies(f'{elastic}*STEP\n{frequency}*BOUNDARY\nTOP, 1, 3\n*END STEP\n', 'springs')
        self.assertEqual(len(wanted), 4)
        for option, bound in (('', 0.01), (', NLGEOM', 0.002)):
            slid = deck.replace('*STEP, INC', f'*STEP{option}, INC')
            found = frequencies(f'{slid}*STEP, PERTURBATION\n{frequency}*END STEP\n', 'slid')
            off = worst_of(abs(a / b - 1) for a, b in zip(found, wanted))
            print(f'  CalculiX, frequencies about a contact that has slid{option}: {off:.1e} off those of its springs')
            self.assertEqual(len(found), 4)
            self.assertLess(off, bound)

    def test_orthotropic_friction_converges_under_uneven_pressing(self):
        for name, constants in (('associated, ratio 0.9', [0, 0.9, 0]), ('associated, ratio 0.5', [0, 0.5, 0]),
                                ('radial, ratio 0.5', [0, 0.5, 1]), ('associated, ratio 2', [0, 2, 0])):
            with self.subTest(law=name):
                run_text(layer_deck.deck(4, LAYER, material([2, 1000, 800, 0.4, *constants]), layer_deck.PRESSED), self.folder,
                         'pressed')
                counts = iterations(self.folder, 'pressed')
                print(f'\n  orthotropic Coulomb friction, {name}: {len(counts)} increments, iterations at most {max(counts)}')
                self.assertEqual(len(counts), 10)   # none was cut

    def test_radial_sliding_converges_under_shear_and_its_reversal(self):
        for ratio in (0.5, 5.0):
            for option in ('', ', NLGEOM'):
                steps = (layer_deck.PRESSED + layer_deck.SHEARED).replace('*STEP', '*STEP' + option)
                run_text(layer_deck.deck(4, LAYER, material([2, 1000, 800, 0.4, 0, ratio, 1]), steps), self.folder, 'reversed')
                counts = iterations(self.folder, 'reversed')
                print(f'\n  radial friction, ratio {ratio}{option}, reversed: {len(counts)} increments, iterations at most {max(counts)}')
                self.assertEqual(len(counts), 30)   # none was cut

    def test_a_first_pressing_converges_in_which_most_of_the_surface_slips(self):
        for mu in (0.25, 0.28, 0.3):
            deck = layer_deck.deck(4, LAYER, material([2, 1000, 800, mu]), layer_deck.PRESSED)
            self.assertTrue(run_text(deck, self.folder, 'pressed'))   # it ended as it should
            print(f'\n  Coulomb friction, {mu}, pressed: {iterations(self.folder, "pressed")} iterations')

    def test_slider_sticks_and_slips_like_the_program(self):
        tables = run_deck('slider', self.folder, [1, 1000, 1000, 0.4, 0.2, 10, 10, 1000])
        found = positions(tables)
        own = self.run_program(
            "law='subloading', alpha_n=1000, alpha_t=1000, mu_s=0.4, mu_k=0.2, kappa=10, xi=10, m=1000", 8)
        self.assertEqual(len(found), 8000)
        worst = worst_of(abs(found[step] - own[step]) for step in found)
        print(f'\n  slider: slips {own[5000]:.3f} mm at 4 s; worst difference over 8000 steps {worst:.1e} mm')
        self.assertGreater(own[5000], 3.0)
        self.draw(found, own)
        # both solve the same equations; what differs is their tolerance, seen through two slip events
        self.assertLess(worst, 1e-4)

    def run_program(self, friction, t_end):
        """Displacements by step, of the slider in the program."""
        (self.folder / 'slider.nml').write_text(f"""
            &friction {friction} /
            &slider mass=1e-3, stiffness=1, normal_traction=10 /
            &drive velocity=1 /
            &time t_end={t_end}, dt=1e-3 /""")
        subprocess.run([os.environ['STICKSLIP'], 'run', 'slider.nml', '--no-plot', '--quiet'], cwd=self.folder,
                       check=True)
        with open(self.folder / 'slider_out/slider.csv', newline='', encoding='utf-8') as file:
            return {round(1e3 * float(row['time'])): float(row['displacement']) for row in csv.DictReader(file)}

    def test_rate_and_state_slider_goes_from_one_dynamic_step_to_the_next(self):
        # Before the second step CalculiX asks for the forces of the sheared contact, with no time increment of its own.
        def in_two_steps(deck):
            head, step = deck.split('** pulled with')
            step = '** pulled with' + step.replace('1.E-3, 8.', '1.E-3, 1.')
            return head.replace('NAME=DRIVE', 'NAME=DRIVE, TIME=TOTAL TIME') + step + step

        found = positions(run_deck('slider', self.folder, [4, 1000, 1000, 0.01, 0.015, 0.01, 1, 0.1], in_two_steps))
        own = self.run_program("law='rate_and_state', alpha_n=1000, alpha_t=1000, a=0.01, b=0.015, d_c=0.01, v0=1, f0=0.1", 2)
        self.assertEqual(len(found), 2000)
        worst = worst_of(abs(found[step] - own[step]) for step in found)
        print(f'\n  slider under rate-and-state friction: slips {own[2000]:.3f} mm in 2 s; worst difference {worst:.1e} mm')
        self.assertGreater(own[2000], 0.5)
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
            set key top left
            plot 'calculix_slider.dat' using 1:($1-$3) with lines linewidth 4 linecolor 'gray70' title 'stickslip', \
                 '' using 1:($1-$2) with lines linewidth 1 linecolor 'black' title 'CalculiX'"""
        subprocess.run(['gnuplot'], input=commands, text=True, check=True)


if __name__ == '__main__':
    unittest.main()
