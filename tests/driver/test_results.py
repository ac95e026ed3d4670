"""What an earlier run of the same name has left does not stand beside the results of a new one.

STICKSLIP names the program.
"""
import unittest

from test_program import INPUTS, Program, namelist

KINDS = 'csv', 'gp', 'png', 'svg'
OF_RUN = [f'case{table}.{kind}' for table in ('', '_events', '_blocks', '_fields') for kind in KINDS] + [
    'case_pieces.csv', 'case_picture.csv', 'case_global.csv', 'case_contours.csv', 'case_station_1.csv', 'case_station_2.csv',
    'case_fields.h5', 'case_fields.xdmf', 'case_fields.dat', 'case_fields_000001.h5', 'case_fields_000002.h5', 'case_fields_000001.bin',
    'case.checkpoint']
OF_SWEEP = [f'case_sweep.{kind}' for kind in KINDS]
OF_STABILITY = [f'case_stability.{kind}' for kind in KINDS] + ['case_stability_map.csv', 'case_stability_boundary.csv', 'case_eigenvalues.csv']
OTHERS = ['case_sweep.journal', 'case_sweep_part_1.journal', 'case.nml', 'case_notes.txt', 'case2.png', 'case_events_old.png', 'other.csv', '.png']
POINT = (INPUTS / 'point_hysteresis.nml').read_text()


class Results(Program):
    def leave_old(self, *names):
        self.folder.joinpath('case_out').mkdir(exist_ok=True)
        for name in names:
            (self.folder / 'case_out' / name).write_text('old\n')

    def still_old(self):
        return {path.name for path in (self.folder / 'case_out').iterdir() if path.is_file() and path.read_bytes() == b'old\n'}

    def test_a_new_run_of_any_verb_removes_its_own_old_results_and_nothing_else(self):
        everything = [*OF_RUN, *OF_SWEEP, *OF_STABILITY, *OTHERS]
        sweep = namelist() + "&sweep key = 'drive%velocity', values = 1, 2 /\n"
        for verb, text, own in (('run', namelist(), OF_RUN), ('point', POINT, OF_RUN), ('stability', namelist(), OF_STABILITY),
                                ('sweep', sweep, OF_SWEEP)):
            self.leave_old(*everything)
            if verb == 'sweep':
                for journal in ('case_sweep.journal', 'case_sweep_part_1.journal'):   # of another input: that would be refused
                    (self.folder / 'case_out' / journal).unlink()
            kept = self.still_old() - set(own)
            result = self.run_text(text, '--no-plot', verb=verb)
            self.assertIn(result.returncode, (0, 1), result.stderr)   # no steady sliding at a velocity that may be 0
            self.assertEqual(self.still_old(), kept, verb)

    def test_a_run_that_is_refused_or_resumed_and_a_part_of_a_sweep_remove_nothing(self):
        pictures = [name for name in OF_RUN if name.endswith('png')] + OF_SWEEP
        self.leave_old(*OF_RUN, *OF_SWEEP)
        for text, arguments in ((namelist({('slider', 'mass'): '-1'}), ()), (namelist(), ('--resume',))):
            self.assertEqual(self.run_text(text, '--no-plot', *arguments).returncode, 2)
            self.assertEqual(self.still_old(), {*OF_RUN, *OF_SWEEP})
        sweep = namelist() + "&sweep key = 'drive%velocity', values = 1, 2 /\n"
        self.assertEqual(self.run_text(sweep, '--no-plot', '--part', '1/2', verb='sweep').returncode, 0)
        self.assertLessEqual(set(pictures), self.still_old())

    def test_results_of_an_input_with_the_name_of_one_of_our_tables_stay(self):
        # results/case_blocks.csv and its pictures are a run of case_blocks.nml; so are a point's case_events.csv and a run's case_pieces.csv
        self.leave_old('case_blocks_events.csv', 'case_blocks.csv', 'case_blocks.png', 'case_pieces.csv', 'case_pieces.gp', 'case_fields.png')
        (self.folder / 'case_out/case_fields.csv').write_text('time,u_n\n0,0\n')
        kept = self.still_old()
        self.assertEqual(self.run_text(namelist(), '--no-plot').returncode, 0)
        self.assertEqual(self.still_old(), kept)
        self.assertTrue((self.folder / 'case_out/case_fields.csv').exists())

    def test_a_result_that_is_a_link_is_left_to_who_made_it(self):
        self.leave_old('case.png')
        (self.folder / 'kept.png').write_text('old\n')
        (self.folder / 'case_out/case.svg').symlink_to(self.folder / 'kept.png')
        self.assertEqual(self.run_text(namelist(), '--no-plot').returncode, 0)
        self.assertFalse((self.folder / 'case_out/case.png').exists())
        self.assertEqual((self.folder / 'case_out/case.svg').read_text(), 'old\n')


if __name__ == '__main__':
    unittest.main()
