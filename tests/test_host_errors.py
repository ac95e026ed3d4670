"""What a user of CalculiX or Kratos sees of an error in the friction routine: a line that names the cause, and the
end of the run. Each error is met in a process of its own, which loads the host's library and calls `umat_` in it.

STICKSLIP_CALCULIX, STICKSLIP_KRATOS: the shared libraries.
"""
import os
import subprocess
import sys
import unittest

CALL = """
import ctypes, sys
path, host, material, components, states, dtime, thickness, modulus, strain, *numbers = sys.argv[1:]
components, states = int(components), int(states)
props = [float(number) for number in numbers]
if host == 'calculix':
    props = [float(thickness), float(modulus), *props]
Six, Full, State = ctypes.c_double * 6, ctypes.c_double * 36, ctypes.c_double * states
real, whole = (lambda x: ctypes.byref(ctypes.c_double(x))), (lambda k: ctypes.byref(ctypes.c_int(k)))
unset, zero = (None if host == 'kratos' else real(0.0)), Full()
time = (ctypes.c_double * 2)()
shear = Six(float(strain), 0.0, -0.01, 0.0, 0.01, 0.0)
name = ctypes.create_string_buffer(material.encode().ljust(80))
step, cut = (ctypes.c_int * 4)(1, 1, 0, 0), ctypes.c_double(-1.0)
ctypes.CDLL(path).umat_(
    Six(), State(), Full(), real(0.0), real(0.0), real(0.0), unset, unset and zero, unset and zero, unset, Six(), shear,
    time, real(float(dtime)), unset, unset, unset, unset, name, whole(3), whole(3), whole(components), whole(states),
    (ctypes.c_double * len(props))(*props), whole(len(props)), unset and zero, unset and zero,
    None if host == 'kratos' else ctypes.byref(cut), unset, unset and zero, unset and zero, whole(7), whole(5),
    unset, unset, step, whole(1), ctypes.c_size_t(80))
print('solved' if cut.value < 0 else f'cut {cut.value}')
"""

RATE_AND_STATE = (4, 1000, 800, 0.01, 0.015, 1e-3, 1.0, 0.4)


class Errors(unittest.TestCase):
    def call(self, host, props, dtime=0.1, material='@ABAQUS_STICKSLIP', layer=(0.1, 1.0, 0.0), sizes=(6, 8)):
        library = os.environ['STICKSLIP_' + host.upper()]
        numbers = map(str, (*sizes, dtime, *layer, *props))
        return subprocess.run([sys.executable, '-c', CALL, library, host, material, *numbers], text=True,
                              capture_output=True, check=False)

    def test_valid_input_is_solved(self):
        for host in ('calculix', 'kratos'):
            result = self.call(host, RATE_AND_STATE)
            self.assertEqual((result.returncode, result.stdout), (0, 'solved\n'), result.stderr)

    def test_calculix_hears_the_cause_and_stops_with_201(self):
        for code, props, dtime in ((-2, (77, *RATE_AND_STATE[1:]), 0.1), (-3, (2, 1000, 800, -0.4), 0.1),
                                   (-1, (2, 1000, 800), 0.1), (-9, RATE_AND_STATE, 0.0)):
            result = self.call('calculix', props, dtime)
            self.assertEqual(result.returncode, 201, result.stdout + result.stderr)
            self.assertRegex(result.stdout, rf'\*ERROR in umat: stickslip, UMAT, code {code}: .*, element 7, point 5')

    def test_constants_at_fault_are_named_as_far_as_there_is_room(self):
        nan = float('nan')
        for props, named in (
                ((1, 1000, -1, 0.2, 0.4, 8, 0.2, -1), 'alpha_t must be > 0, mu_s must be >= mu_k, m must be > 0, el'),
                ((1, 1000, 800, 0.4, 0.2, 8, 0.2, 60, 0.1), 'mu_0 must be from mu_k to mu_s, element'),
                ((2, 1000, 800, -0.4, -1, 0.5, 1, -1), 'mu must be >= 0, tau_max must be >= 0, cohesion must be >= 0, element'),
                ((2, -1, nan, -1), 'the constants must be finite numbers, up to 1.7e100, element'),
                ((2, -1, 800), 'mu is missing, element'), ((77, -1), 'the first constant must be the number of a law, element'),
                ((7, *[-1] * 16), 'alpha_n must be > 0, .*n must be from 1 to 1000, .*, element')):
            with self.subTest(props=props):
                self.assertRegex(self.call('calculix', props).stdout, f': {named}.*7, point 5')
        self.assertIn('code -1: ', self.call('calculix', ()).stdout)

    def test_sizes_are_those_of_the_host(self):
        for host, place in (('calculix', 'stdout'), ('kratos', 'stderr')):
            for sizes in ((6, 7), (4, 8)):   # components of the stress, numbers of the state
                with self.subTest(host=host, sizes=sizes):
                    result = self.call(host, RATE_AND_STATE, sizes=sizes)
                    self.assertIn('code -1: ', getattr(result, place))
                    self.assertNotIn('solved', result.stdout)
            self.assertEqual(self.call(host, RATE_AND_STATE, sizes=(6, 12)).stdout, 'solved\n')

    def test_a_layer_refuses_what_the_friction_routine_does_not_see(self):
        nan = float('nan')
        for code, layer in ((-3, (0.0, 1.0, 0.0)), (-3, (nan, 1.0, 0.0)), (-3, (1e-320, 1.0, 0.0)), (-3, (1e200, 1.0, 0.0)),
                            (-3, (0.1, -1.0, 0.0)), (-3, (0.1, 1e200, 0.0))):
            with self.subTest(thickness=layer[0], modulus=layer[1], strain=layer[2]):
                result = self.call('calculix', (2, 1000, 800, 0.4), layer=layer)
                self.assertEqual(result.returncode, 201, result.stdout + result.stderr)
                self.assertIn(f'code {code}: ', result.stdout)
                self.assertIn('the thickness of the layer must be > 0', result.stdout)

    def test_calculix_cuts_strains_that_iterations_left_which_diverged(self):
        nan = float('nan')
        for layer in ((0.1, 1.0, nan), (0.1, 0.0, nan), (0.1, 1.0, 1e160), (0.1, 1e90, 1e90)):
            with self.subTest(modulus=layer[1], strain=layer[2]):
                result = self.call('calculix', (2, 1000, 800, 0.4), layer=layer)
                self.assertEqual((result.returncode, result.stdout), (0, 'cut 0.25\n'), result.stderr)

    def test_calculix_hears_that_its_other_interface_is_not_served(self):
        result = self.call('calculix', RATE_AND_STATE, material='@ABAQUSNL_STICKSLIP')
        self.assertEqual(result.returncode, 201, result.stdout + result.stderr)
        self.assertRegex(result.stdout, r'\*ERROR in umat: .*@ABAQUSNL_STICKSLIP .*write @ABAQUS_STICKSLIP.*, element 7')

    def test_kratos_hears_the_cause_and_stops(self):
        for code, props, dtime in ((-2, (77, *RATE_AND_STATE[1:]), 0.1), (-3, (2, 1000, 800, -0.4), 0.1),
                                   (-1, (2, 1000, 800), 0.1), (-9, RATE_AND_STATE, 0.0)):
            result = self.call('kratos', props, dtime)
            self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
            self.assertIn(f'stickslip, Kratos UMAT, code {code}: ', result.stderr)
            self.assertNotIn('solved', result.stdout)


if __name__ == '__main__':
    unittest.main()
