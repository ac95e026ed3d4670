#!/usr/bin/env python3
"""Would the tests see a fault? Makes single-line changes to the library's sources, one at a time, and runs the unit tests on
each until one fails. Changes that no test notices are listed.

What is changed: a comparison and its bound (< and <=), the sense of a comparison, a sign, an operation, .and. and .or.,
a .not., a coefficient, min and max, and conditions of one line, which are dropped with what they do.

All mutants are compiled at once, and a number chooses one when a test runs (mutant_switches.py). Only tests for which it has
another value somewhere can notice it: of these, tests that noticed others of its file come first, then the short ones. What an
optimising compiler makes the same object of is no change. Results go into a journal as they come, and what it holds is not
tried again, but survivors are.

A survivor that makes no difference belongs into tests/mutants_equivalent.txt: file | line | mutation | reason, where ...
stands for anything. Lines are found again by their text.
"""
import argparse
import collections
import concurrent.futures
import fnmatch
import gzip
import json
import os
import pathlib
import random
import re
import resource
import shlex
import shutil
import subprocess
import sys
import tempfile
import threading

import mutant_switches

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
SCRIPTS = ('test_host_errors', 'test_mgis')   # among the tests, those that reach what no program does
MOST = 2000   # mutants of a file
NO_STATEMENT = re.compile(r'^\s*($|!|use |end\b|contains|implicit|private|public|import|interface|abstract|module |submodule'
                          r'|(pure |elemental |module |recursive )*(subroutine|function)\b|procedure|type\b|else$|select|case )')
CONDITION = re.compile(r'^(\s*)if \(.*\) (return|exit|cycle|\w+(%\w+|\([^()]*\))* = .*)$')


class Mutant:
    def __init__(self, file, text, number, new, what):
        self.file, self.text, self.number, self.new, self.what = file, text, number, new, what
        lines = text.splitlines()
        self.old = lines[number - 1]
        self.copy = sum(line.strip() == self.old.strip() for line in lines[:number - 1])   # lines before with the same text

    def key(self):
        return self.file, ' '.join(self.old.split()), self.what, self.copy

    def __str__(self):
        return f'{self.file}:{self.number}: {self.what}\n    {self.old.strip()}\n    {self.new.strip()}'


def code_of(line):
    """A line without its comment; texts are blanked, so that places stay."""
    line = re.sub(r"'[^']*'|\"[^\"]*\"", lambda text: '#' * len(text.group()), line)
    return line.split('!')[0]


def mutants_of(file):
    text = (ROOT / file).read_text()
    for number, line in enumerate(text.splitlines(), 1):
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
                    yield Mutant(file, text, number, line[:match.start()] + new + line[match.end():],
                                 f'{match.group().strip()} -> {new.strip()} ({found})')
        for found, match in enumerate(NUMBER.finditer(code), 1):
            if match.start() >= start:
                new = '1.0_wp' if float(match.group()[:-3]) == 0 else f'(1.5_wp * {match.group()})'
                yield Mutant(file, text, number, line[:match.start()] + new + line[match.end():],
                             f'{match.group()} -> {new} ({found})')
        condition = CONDITION.match(code)
        if condition and not code.endswith('&'):
            yield Mutant(file, text, number, condition.group(1) + 'continue', 'dropped')


def known_equivalents():
    """What is explained: of each file, text of the line and mutation, with ... for anything."""
    known = collections.defaultdict(list)
    for line in EQUIVALENT.read_text().splitlines():
        if line.strip() and not line.startswith('#'):
            file, *parts, _ = (part.strip() for part in line.split(' | '))
            text, what = (re.compile(re.escape(part).replace(r'\.\.\.', '.*')) for part in parts)
            known[file].append((text, what))
    return known


def explains(patterns, mutant):
    return all(pattern.fullmatch(part) for pattern, part in zip(patterns, mutant.key()[1:3]))


def run(command, **options):
    return subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)


class Test:
    """A test of the suite: its command, where it runs, the sources that it holds, the time that it takes."""

    def __init__(self, name, command, folder, sources=(), environment=()):
        self.name, self.command, self.folder, self.sources = name, command, folder, sources
        self.environment = dict(setting.split('=', 1) for setting in environment)
        self.seconds, self.notes = 0.0, b''

    def passes(self, mutant=0, preload=(), limit=1000.0, **environment):
        """Runs with a mutant, or with libraries that come first; the limit is one of CPU time, since the machine may be busy."""
        environment = dict(os.environ, **self.environment, **environment, LD_PRELOAD=':'.join(map(str, preload)), OMP_NUM_THREADS='2', OMP_WAIT_POLICY='passive',
                           STICKSLIP_MUTANT=str(mutant), STICKSLIP_SECONDS=str(limit))
        try:
            return run(self.command, cwd=self.folder, env=environment, timeout=60 * limit + 60).returncode == 0
        except (subprocess.TimeoutExpired, UnicodeDecodeError):
            return False

    def measure(self, limit):
        begun = resource.getrusage(resource.RUSAGE_CHILDREN)
        passes = self.passes(limit=2 * limit)
        self.seconds = 0.005 + sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2]) - sum(begun[:2])
        return passes

    def take_notes(self, folder, size):
        """Which mutants' statements it reaches, and which would have another value; whatever it does, if it fails like that."""
        notes = folder / f'{self.name}.notes'
        notes.write_bytes(bytes(size + 1))
        passes, before = False, None
        while not passes and notes.read_bytes() != before:   # until no value is asked for that ends the program
            before = notes.read_bytes()
            passes = self.passes(-1, STICKSLIP_NOTES=str(notes), STICKSLIP_MUTANTS=str(size), GFORTRAN_ERROR_BACKTRACE='0')
        self.notes = notes.read_bytes() if passes else bytes([3]) * (size + 1)
        return passes


def build_files(library):
    """The build's files, changed: what is loaded first takes the place of the same in the library, which is no object of one piece
    and hides no name."""
    changed = {pathlib.Path(name): (ROOT / name).read_text() for name in ('CMakeLists.txt', 'src/CMakeLists.txt')}
    for name, old, new in (('CMakeLists.txt', 'include(CheckLanguage)', f'link_libraries({library} gfortran)\ninclude(CheckLanguage)'),
                           ('CMakeLists.txt', ';-fno-semantic-interposition', ''), ('src/CMakeLists.txt', ' -fno-semantic-interposition', ''),
                           ('src/CMakeLists.txt', '-O3', '-O1'),
                           ('src/CMakeLists.txt', 'set(library_sources', 'set(library_sources\n    mutant_switch_kernel.f90')):
        if old not in changed[pathlib.Path(name)]:
            sys.exit(f'{name}: no {old}')
        changed[pathlib.Path(name)] = changed[pathlib.Path(name)].replace(old, new)
    for name, content in (('OneObject', 'set(stickslip_one_object OFF)\n'),
                          ('ExportOnly', 'function(stickslip_export_only)\nendfunction()\nfunction(stickslip_export_header)\nendfunction()\n')):
        changed[pathlib.Path(f'cmake/{name}.cmake')] = content
        if f'cmake/{name}.cmake)' not in ''.join(changed.values()):
            sys.exit(f'No cmake/{name}.cmake is included')
    return {name: text.encode() for name, text in changed.items()}


class Base:
    """The library and the test programs, built of a copy of the project in which each source holds its mutants: a number in
    the environment chooses one (mutant_switches.py). What cannot be put so is compiled alone and loaded first (LD_PRELOAD)."""

    def __init__(self, limit, jobs, every):
        self.build, self.tree, self.settled = (ROOT / 'build/mutants' / name for name in ('build', 'tree', 'settled'))
        self.plain, self.plain_libraries, self.one_at_a_time = ROOT / 'build/mutants/plain', {}, threading.Lock()
        shutil.rmtree(self.plain, ignore_errors=True)
        self.plain.mkdir(parents=True)
        self.number_of, self.switched = {}, {}
        self.switch(every)
        fortran = ['-DCMAKE_BUILD_TYPE=Release', '-DCMAKE_Fortran_FLAGS_RELEASE=-O1 -ffree-line-length-none']
        for command in (['cmake', '-S', str(self.tree), '-B', str(self.build), '-G', 'Unix Makefiles', '-DSTICKSLIP_BUILD_DRIVER=OFF',
                         '-DSTICKSLIP_VECTOR_KERNELS=OFF', *fortran], ['cmake', '--build', str(self.build), f'-j{jobs}']):
            built = run(command)
            if built.returncode:
                sys.exit('The sources do not build as they are:\n' + built.stdout[-3000:])
        self.modules = sorted({path.parent for path in self.build.rglob('*.mod')}, key=lambda path: (path.parts[-3:-1] != ('build', 'src'), path))
        paths = {path.name: path for path in sorted((self.tree / 'src').rglob('*.f90'))}
        self.libraries, self.contents, self.objects = {}, {}, {}
        for archive in self.build.rglob('lib*.a'):
            library = self.libraries[archive.stem] = self.build / 'shared' / f'{archive.stem}.so'
            library.parent.mkdir(exist_ok=True)
            run(['gfortran', '-shared', '-fopenmp', '-Wl,--whole-archive', str(archive), '-Wl,--no-whole-archive', '-o', str(library)], check=True)
            self.contents[library] = [name.removesuffix('.o') for name in run(['ar', 't', str(archive)]).stdout.split()]
            for single in set(self.contents[library]) & {'stickslip_abaqus_standard.f90', 'stickslip_abaqus_explicit.f90'}:
                source = self.build / 'src/adapters' / single
                self.contents[library] += [name for name, path in paths.items() if path.read_text() in source.read_text()]
        self.sources = self.in_order()
        self.tests = []
        listed = json.loads(run(['ctest', '--test-dir', str(self.build), '--show-only=json-v1']).stdout)
        for test in listed['tests']:
            settings = {item['name']: item['value'] for item in test['properties']}
            target = pathlib.Path(test['command'][0]).name
            link = self.build / f'tests/CMakeFiles/{target}.dir/link.txt'
            if test['name'] in SCRIPTS:
                self.tests.append(Test(test['name'], test['command'], settings['WORKING_DIRECTORY'], environment=settings['ENVIRONMENT']))
            elif link.exists() and str(self.build) not in ' '.join(test['command'][1:]):   # others are scripts or load a library by its place
                program, sources = self.linked(target, link.read_text())
                self.tests.append(Test(test['name'], [str(program), *test['command'][1:]], settings['WORKING_DIRECTORY'], sources))
        for test in self.tests:
            if not test.measure(limit) and test.seconds <= limit:
                sys.exit(f'{test.name} fails on the sources as they are')
        self.tests = [test for test in self.tests if test.seconds <= limit]
        for test in self.tests:
            if not test.take_notes(self.build, MOST * len(self.sources)):
                print(f'{test.name} fails when it takes notes: no mutant is left out')

    def in_order(self):
        """The sources of the library, what is used first."""
        text = {source: source.read_text() for source in sorted((ROOT / 'src').rglob('*.f90'))}
        home = {name: source for source in text for name in re.findall(r'^module (\w+)$', text[source], re.MULTILINE)}
        ordered = []

        def add(source):
            for name in re.findall(r'^ *(?:use |submodule *\()(\w+)', text[source], re.MULTILINE):
                if home.get(name, source) not in (source, *ordered):
                    add(home[name])
            if source not in ordered:
                ordered.append(source)
        for source in text:
            add(source)
        return ordered

    def switch(self, every):
        """Makes the copy of the project."""
        of_file = collections.defaultdict(list)
        for mutant in every:
            of_file[mutant.file].append(mutant)
        for folder in (self.settled, self.build):
            folder.mkdir(parents=True, exist_ok=True)
        support = ROOT / 'tests/support'
        library = self.settled / 'libmutant_switch.so'
        run(['gcc', '-O1', '-shared', '-fPIC', str(support / 'mutant_switch.c'), '-o', str(library)], check=True)
        files = {path.relative_to(ROOT): path.read_bytes() for folder in ('src', 'tests', 'include', 'cmake', 'docs', 'examples')
                 for path in (ROOT / folder).rglob('*') if path.is_file() and '__pycache__' not in path.parts}
        files.update({pathlib.Path(name): (ROOT / name).read_bytes() for name in ('CMakeLists.txt', 'LICENSE', 'README.md')})
        files[pathlib.Path('src/mutant_switch_kernel.f90')] = (support / 'mutant_switch.f90').read_bytes()
        run(['gfortran', '-c', '-J', str(self.settled), str(support / 'mutant_switch.f90'), '-o', str(self.settled / 'switch.o')], check=True)
        for place, source in enumerate(self.in_order()):   # where the numbers of a file begin does not depend on other files
            name = source.relative_to(ROOT)
            switched = self.switched[str(name)] = mutant_switches.Switched(source, of_file[str(name)], 1 + place * MOST).settle(self.settled)
            self.number_of.update({mutant: it for it, mutant in switched.numbers().items()})
            files[name] = (self.settled / source.name).read_bytes()
        files.update(build_files(library))
        for name, content in files.items():
            target = self.tree / name
            if not target.exists() or target.read_bytes() != content:
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_bytes(content)

    def linked(self, target, command):
        sources = set()

        def shared(match):
            library = self.libraries.get(match.group(1), match.group())
            sources.update(self.contents.get(library, ()))
            return str(library)
        command = re.sub(r'\S*\b(lib\w+)\.(?:a|so)[\d.]*(?= |$)', shared, command.strip())
        program = self.build / 'shared' / target
        command = re.sub(r' -o \S+', f' -o {program} -Wl,--no-as-needed', command)
        run(shlex.split(command), cwd=self.build / 'tests', check=True)
        return program, sources

    def compile(self, source, folder, *options):
        """Compiles one source into a folder, its modules too; true if it compiles."""
        includes = [part for path in (folder, *self.modules) for part in ('-I', str(path))]
        return run(['gfortran', '-std=f2008', '-fPIC', '-fopenmp', '-w', '-ffree-line-length-none', '-J', str(folder), *includes, *options, str(source)],
                   cwd=folder).returncode == 0

    def unchanged(self, file):
        """The library of one source without a change, compiled like a mutant."""
        with self.one_at_a_time:
            if file not in self.plain_libraries:
                library = self.plain / f'{pathlib.Path(file).stem}.so'
                compiles = self.compile(self.settled / pathlib.Path(file).name, self.plain, '-O0', '-shared', '-o', str(library))
                self.plain_libraries[file] = library if compiles else None
            return self.plain_libraries[file]

    def fate(self, mutant, kills, folder):
        """What becomes of the mutant: the test that notices it, 'does not compile', 'same object' or 'survives'."""
        number = self.number_of.get(mutant)
        if number is None:
            return Trial(self, mutant, folder).fate(kills)
        notes = max(test.notes[number] for test in self.tests)
        tests = [test for test in self.tests if test.notes[number] & 2]
        for test in sorted(tests, key=lambda test: test.seconds / (kills[test.name] + 0.3)):
            if not test.passes(number, limit=3 * test.seconds + 0.3):
                return test.name
        if notes and Trial(self, mutant, folder).same_object():
            return 'same object'
        return 'survives' if tests else 'survives: never another value' if notes else 'survives: never run'


class Trial:
    """One mutant, compiled alone, in a folder of its own, of the source with switches: of another text, gfortran may put the procedures
    of a type in another order."""

    def __init__(self, base, mutant, folder):
        self.base, self.mutant, self.folder = base, mutant, folder
        self.source = folder / pathlib.Path(mutant.file).name

    def library(self, source):
        library = self.folder / f'{source.stem}.so'
        return library if self.base.compile(source, self.folder, '-O0', '-shared', '-o', str(library)) else None

    def copy(self, name):
        """The copy of the source that tests compile in quadruple precision, changed likewise."""
        run([sys.executable, str(ROOT / 'tests/support/quad_copy.py'), 'quad', str(self.folder), str(self.source)], check=True)
        return self.library(self.folder / name)

    def interface_changed(self):
        for module in self.folder.glob('*.*mod'):
            before = next((path / module.name for path in self.base.modules if (path / module.name).exists()), None)
            if before and gzip.decompress(before.read_bytes()) != gzip.decompress(module.read_bytes()):
                return True
        return False

    def dependents(self):
        """All that uses the source, compiled again: constants of an interface are copied into their users."""
        changed = {self.source.stem}
        for source in self.base.sources:
            text = source.read_text()
            if changed & set(re.findall(r'^ *(?:use |submodule *\()(\w+)', text, re.MULTILINE)):
                changed.add(source.stem)
                yield str(source.relative_to(ROOT)), self.library(self.base.settled / source.name)

    def same_object(self):
        """Whether an optimising compiler makes the same of the changed source and of the original."""
        lines = self.mutant.text.splitlines()
        lines[self.mutant.number - 1] = self.mutant.new
        changed = '\n'.join(lines) + '\n'
        folder = self.folder / 'compared'
        folder.mkdir()
        for text in (changed, self.mutant.text):
            if text not in self.base.objects:
                source = folder / self.source.name
                source.write_text(text)
                if not self.base.compile(source, folder, '-O2', '-c', '-o', 'compared.o'):
                    return False   # a value that the switch hides from the compiler, such as 1/0
                self.base.objects[text] = (folder / 'compared.o').read_bytes()
        return self.base.objects.pop(changed) == self.base.objects[self.mutant.text]

    def fate(self, kills):
        """What becomes of the mutant: the test that notices it, 'does not compile', 'same object' or 'survives'."""
        switched = self.base.switched[self.mutant.file]
        self.source.write_text('\n'.join(line for line, *_ in switched.write(self.mutant)) + '\n')
        changed = self.library(self.source)
        if changed is None:
            return 'does not compile'
        preload, name, copied = {self.mutant.file: changed}, self.source.name, f'quad_{self.source.name}'
        if self.interface_changed():
            preload.update(self.dependents())
        copy = None
        tests = [test for test in self.base.tests if not {name, copied}.isdisjoint(test.sources)]
        tests.sort(key=lambda test: test.seconds / (kills[test.name] + 0.3))
        for count, test in enumerate(tests):
            if count == 6 and len(preload) == 1 and self.same_object():   # of a constant that others use it is the same anyway
                return 'same object'
            if copied in test.sources:
                copy = copy or self.copy(copied)
            used = [file for file in preload if pathlib.Path(file).name in test.sources]   # hosts have routines of the same name
            limit = 3 * test.seconds + 0.3
            if not test.passes(0, filter(None, [*map(preload.get, used), copy if copied in test.sources else None]), limit):
                # Where all sources are one file, procedures of a type can be in another order: that says nothing.
                if test.passes(0, filter(None, map(self.base.unchanged, used)), limit):
                    return test.name
        return 'survives'


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('pattern', nargs='*', default=['src/*.f90'], help='which files, e.g. "src/laws/*.f90"')
    parser.add_argument('--sample', type=int, help='how many mutants, drawn at random; all, if left out')
    parser.add_argument('--seed', type=int, default=1, help='of the draw')
    parser.add_argument('--jobs', type=int, default=os.cpu_count(), help='how many at the same time')
    parser.add_argument('--limit', type=float, default=3, help='tests that take longer than this are left out [s]')
    parser.add_argument('--journal', type=pathlib.Path, default=ROOT / 'build/mutants.journal', help='what is known already')
    parser.add_argument('--list', action='store_true', help='list the mutants and do nothing')
    parser.add_argument('--check', action='store_true', help='only see whether what is explained and the build are as this expects')
    options = parser.parse_args()

    known = known_equivalents()
    every = [mutant for file in sorted((ROOT / 'src').rglob('*.f90'))
             for mutant in mutants_of(str(file.relative_to(ROOT)))]
    stale = 0
    for file, entries in known.items():
        of_file = [mutant for mutant in every if mutant.file == file]
        for patterns in entries:
            if not any(explains(patterns, mutant) for mutant in of_file):
                stale += 1
                print('tests/mutants_equivalent.txt, no such line or mutation any more:', file, *(it.pattern for it in patterns), sep=' | ')
    build_files('')   # before hours are spent, whether they are as expected
    if options.check:
        return int(stale > 0)
    mutants = list(dict.fromkeys(mutant for pattern in options.pattern for mutant in every if fnmatch.fnmatch(mutant.file, pattern)))
    if options.sample is not None and options.sample < len(mutants):
        mutants = random.Random(options.seed).sample(mutants, options.sample)
    fates = {}
    if options.journal.exists():
        for line in options.journal.read_text().splitlines():
            *key, fate = json.loads(line)
            fates[tuple(key)] = fate
    for mutant in mutants:
        if fates.get(mutant.key(), 'survives').startswith('survives') and any(explains(it, mutant) for it in known[mutant.file]):
            fates[mutant.key()] = 'explained'
    waiting = [mutant for mutant in mutants if fates.get(mutant.key(), 'survives').startswith('survives')]
    print(f'{len(mutants)} mutants, {len(waiting)} to try', flush=True)
    if options.list:
        print(*waiting, sep='\n')
        return 0
    if waiting:
        try_all(every, waiting, fates, options)
    survivors = [mutant for mutant in mutants if fates.get(mutant.key(), 'survives').startswith('survives')]
    counts = collections.Counter(fates[mutant.key()] for mutant in mutants if mutant not in set(survivors))
    aside = {name: counts.pop(name, 0) for name in ('does not compile', 'same object', 'explained')} | {'survive': len(survivors)}
    print(f'\n{len(mutants)} mutants: {sum(counts.values())} noticed,', ', '.join(f'{name}: {it}' for name, it in aside.items()))
    print(*(f'{mutant}\n    {fates.get(mutant.key(), "not tried")}' for mutant in survivors), sep='\n')
    return 1 if survivors else 0


def try_all(every, mutants, fates, options):
    base = Base(options.limit, options.jobs, every)
    print('tests:', ', '.join(f'{test.name} {test.seconds:.2f} s' for test in base.tests), flush=True)
    kills = collections.defaultdict(collections.Counter)
    for (file, *_), fate in fates.items():
        kills[file][fate] += 1

    def attempt(mutant):
        folder = pathlib.Path(tempfile.mkdtemp(prefix='mutant'))
        try:
            return base.fate(mutant, kills[mutant.file], folder)
        finally:
            shutil.rmtree(folder)

    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool, options.journal.open('a') as journal:
        for count, (mutant, fate) in enumerate(zip(mutants, pool.map(attempt, mutants)), 1):
            fates[mutant.key()] = fate
            kills[mutant.file][fate] += 1
            journal.write(json.dumps([*mutant.key(), fate]) + '\n')
            journal.flush()
            print(f'[{count}] {mutant}: {fate}' if fate.startswith('survives') else f'[{count}] {mutant.file}:{mutant.number} {mutant.what}: {fate}',
                  flush=True)


if __name__ == '__main__':
    sys.exit(main())
