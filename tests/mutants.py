#!/usr/bin/env python3
"""Would the tests see a fault? Makes single-line changes to the library's sources, one at a time, in a copy, and runs the
fast tests on each. Changes that no test notices are listed.

What is changed: a comparison and its bound (< and <=), the sense of a comparison, a sign, an operation, .and. and .or.,
a .not., a coefficient, min and max, and conditions of one line, which are dropped with what they do.

A survivor that makes no difference belongs into tests/mutants_equivalent.txt: file | line | mutation | reason. Lines are
found again by their text.
"""
import argparse
import filecmp
import fnmatch
import pathlib
import random
import re
import shutil
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
EQUIVALENT = ROOT / 'tests/mutants_equivalent.txt'
REPLACEMENTS = [
    (r'(?<![<>=/])<(?![=])', ('<=', '>')), (r'<=', ('<', '>=')), (r'(?<![=<>-])>(?![=])', ('>=', '<')), (r'>=', ('>', '<=')),
    (r'==', ('/=',)), (r'/=', ('==',)), (r'(?<=[\w)]) \+ ', (' - ',)), (r'(?<=[\w)]) - ', (' + ',)),
    (r'(?<=[\w)]) \* ', (' / ',)), (r'(?<=[\w)]) / ', (' * ',)), (r'(?<=[=(,]) ?-(?=\w)', (' ',)),
    (r'\.and\.', ('.or.',)), (r'\.or\.', ('.and.',)), (r'\.not\. ', ('',)),
    (r'\bmax\(', ('min(',)), (r'\bmin\(', ('max(',)),
]
NUMBER = re.compile(r'\b\d+\.\d+(?:e-?\d+)?_wp')
NO_STATEMENT = re.compile(r'^\s*($|!|use |end\b|contains|implicit|private|public|import|interface|abstract|module |submodule'
                          r'|(pure |elemental |module |recursive )*(subroutine|function)\b|procedure|type\b|else$|select|case )')
CONDITION = re.compile(r'^(\s*)if \(.*\) (return|exit|cycle|\w+(%\w+)* = .*)$')


class Mutant:
    def __init__(self, file, number, old, new, what):
        self.file, self.number, self.old, self.new, self.what = file, number, old, new, what

    def key(self):
        return self.file, ' '.join(self.old.split()), self.what

    def __str__(self):
        return f'{self.file}:{self.number}: {self.what}\n    {self.old.strip()}\n    {self.new.strip()}'


def code_of(line):
    """A line without its comment; texts are blanked, so that places stay."""
    line = re.sub(r"'[^']*'|\"[^\"]*\"", lambda text: '#' * len(text.group()), line)
    return line.split('!')[0]


def mutants_of(file):
    lines = (ROOT / file).read_text().splitlines()
    for number, line in enumerate(lines, 1):
        code = code_of(line).rstrip()
        if NO_STATEMENT.match(code):
            continue
        start = 0
        if '::' in code:
            if 'parameter' not in code or '=' not in code.split('::')[1]:
                continue
            start = code.index('=', code.index('::'))
        for pattern, replacements in REPLACEMENTS:
            for found, match in enumerate(re.finditer(pattern, code), 1):
                if match.start() < start:
                    continue
                for new in replacements:
                    yield Mutant(file, number, line, line[:match.start()] + new + line[match.end():],
                                 f'{match.group().strip()} -> {new.strip()} ({found})')
        for found, match in enumerate(NUMBER.finditer(code), 1):
            if match.start() >= start:
                new = '1.0_wp' if float(match.group()[:-3]) == 0 else f'(1.5_wp * {match.group()})'
                yield Mutant(file, number, line, line[:match.start()] + new + line[match.end():],
                             f'{match.group()} -> {new} ({found})')
        condition = CONDITION.match(code)
        if condition and not code.endswith('&'):
            yield Mutant(file, number, line, condition.group(1) + 'continue', 'dropped')


def known_equivalents():
    """Keys of the survivors that are explained, with the reason."""
    known = {}
    if EQUIVALENT.exists():
        for line in EQUIVALENT.read_text().splitlines():
            if line.strip() and not line.startswith('#'):
                file, text, what, reason = (part.strip() for part in line.split(' | '))
                known[file, text, what] = reason
    return known


class Copy:
    """A copy of the project in which the mutants are built and tested."""

    def __init__(self, limit, with_hosts):
        self.place = ROOT / 'build/mutants'
        self.source, self.build, self.limit = self.place / 'source', self.place / 'build', limit
        files = subprocess.run(['git', 'ls-files'], cwd=ROOT, text=True, capture_output=True, check=True).stdout.split()
        for old in [path for path in self.source.rglob('*') if path.is_file()]:
            if str(old.relative_to(self.source)) not in files:
                old.unlink()
        for file in filter(lambda it: (ROOT / it).is_file(), files):   # what is as it was is not built again
            (self.source / file).parent.mkdir(parents=True, exist_ok=True)
            if not (self.source / file).exists() or not filecmp.cmp(ROOT / file, self.source / file, shallow=False):
                shutil.copy(ROOT / file, self.source / file)
        self.run(['cmake', '-S', str(self.source), '-B', str(self.build), '-DSTICKSLIP_BUILD_DRIVER=OFF'], check=True)
        listed = re.findall(r'^add_test\((?:\[=\[)?(\w+)(?:\]=\])? "([^"]+)"',
                            (self.build / 'tests/CTestTestfile.cmake').read_text(), re.MULTILINE)
        self.programs = {name: pathlib.Path(program).name for name, program in listed
                         if program.startswith(str(self.build / 'tests'))   # others are scripts
                         and (with_hosts or not re.search('abaqus|calculix|kratos|host|fork', name))}
        self.targets = list(self.programs)
        built = self.make()
        if built.returncode:
            sys.exit('The sources do not build as they are:\n' + built.stdout[-3000:])
        self.times = {}
        for target in self.targets:
            begun = time.monotonic()
            if self.fails(target, 10 * limit):
                print(f'left out, because it fails or takes long on the sources as they are: {target}')
            elif time.monotonic() - begun <= limit:
                self.times[target] = time.monotonic() - begun
        self.targets = sorted(self.times, key=self.times.get)

    def run(self, command, check=False):
        return subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=check)

    def make(self):
        return self.run(['nice', 'cmake', '--build', str(self.build), '-j2', '--target', *sorted(set(self.programs[target] for target in self.targets))])

    def fails(self, target, limit):
        return self.run(['ctest', '--test-dir', str(self.build), '-R', f'^{target}$', '--timeout', f'{limit:.0f}']).returncode != 0

    def fate(self, mutant):
        """What becomes of a mutant: the test that kills it, 'does not compile', or 'survives'."""
        path = self.source / mutant.file
        original = path.read_text()
        lines = original.splitlines()
        lines[mutant.number - 1] = mutant.new
        path.write_text('\n'.join(lines) + '\n')
        try:
            if self.make().returncode:
                return 'does not compile'
            for target in self.targets:
                if self.fails(target, 10 * self.times[target] + 10):
                    return target
            return 'survives'
        finally:
            path.write_text(original)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('pattern', nargs='*', default=['src/friction_*.f90', 'src/laws/*.f90'],
                        help='which files, e.g. "src/laws/*.f90"')
    parser.add_argument('--sample', type=int, help='how many mutants, drawn at random; all, if left out')
    parser.add_argument('--seed', type=int, default=1, help='of the draw')
    parser.add_argument('--limit', type=float, default=5, help='tests that take longer than this are left out [s]')
    parser.add_argument('--list', action='store_true', help='list the mutants and do nothing')
    options = parser.parse_args()

    files = sorted(str(file.relative_to(ROOT)) for file in (ROOT / 'src').rglob('*.f90'))
    files = [file for file in files if any(fnmatch.fnmatch(file, pattern) for pattern in options.pattern)]
    known = known_equivalents()
    mutants = [mutant for file in files for mutant in mutants_of(file)]
    stale = set(known) - {mutant.key() for mutant in mutants if mutant.key() in known}
    if options.pattern == parser.get_default('pattern') and stale:
        print('no such line or mutation any more, in tests/mutants_equivalent.txt:', *sorted(stale), sep='\n    ')
    total = len(mutants)
    mutants = [mutant for mutant in mutants if mutant.key() not in known]
    if options.sample is not None and options.sample < len(mutants):
        mutants = sorted(random.Random(options.seed).sample(mutants, options.sample), key=lambda it: (it.file, it.number))
    print(f'{len(mutants)} of {total} mutants in {len(files)} files, {total - len(mutants)} left out; '
          f'{len(known)} are known to be equivalent', flush=True)
    if options.list:
        print(*mutants, sep='\n')
        return 0
    copy = Copy(options.limit, any('adapters' in file for file in files))
    print('tests:', ', '.join(copy.targets), flush=True)
    survivors, broken = [], 0
    for count, mutant in enumerate(mutants, 1):
        fate = copy.fate(mutant)
        broken += fate == 'does not compile'
        if fate == 'survives':
            survivors.append(mutant)
            print(f'[{count}] SURVIVES {mutant}', flush=True)
        else:
            print(f'[{count}] {mutant.file}:{mutant.number} {mutant.what}: {fate}', flush=True)
    print(f'\n{len(mutants) - broken} mutants, {len(mutants) - broken - len(survivors)} noticed, {len(survivors)} survive '
          f'({broken} did not compile)')
    print(*survivors, sep='\n')
    return 1 if survivors else 0


if __name__ == '__main__':
    sys.exit(main())
