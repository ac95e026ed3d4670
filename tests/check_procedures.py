#!/usr/bin/env python3
"""Procedures: none is longer than a screen, none takes more arguments than one can keep in mind, and gfortran bears them.

    tests/check_procedures.py [ROOT]

Looks at all Fortran below src, driver, tests, bench, examples and cmake. A procedure has at most 60 lines, those of
the procedures inside it with them, and eight arguments, the object that it belongs to (`self`) not counted.
EXCEPTIONS names those that may have more, with the reason; one that is not needed is a fault, too.

No result and no argument of a procedure of a type has bounds or a length that call a function: an `allocatable` result,
or `(:)`. Each module that uses such a type writes the call into its module file. If the function (`size`, say) is not known
there, gfortran 12 enters its name into the table of names that it is just walking through, passes others over, and breaks
down now and then: what is added to quite another module decides it.

Exit status 1 with a line for each fault.
"""
import pathlib
import re
import sys

FOLDERS = ('src', 'driver', 'tests', 'bench', 'examples', 'cmake')
LONGEST = 60   # lines of a procedure
WIDEST = 8     # arguments

HOST = "the host's own argument list"
C = 'as published in friction.h: C has no arrays with bounds'
PUBLISHED = 'a published argument list'
LAPACK = "LAPACK's argument list"
BOUNDS = 'the arrays of a published call, which travel without descriptors, with their sizes'
KERNEL = 'the arrays of a block of points, passed to a kernel as C passes them'
ADAPTER = "the numbers of a host's call, handed on as they come"
WORK = "arrays of all unknowns or blocks, the caller's, so that no step allocates"
LOOPS = 'loops over one block, whose temporary numbers stay in registers'
PARTS = 'its parts change the same variables, and are inner procedures; none has 60 lines without the others'

# (file, procedure): reason; '*' for all procedures of a file
EXCEPTIONS = {
    ('src/adapters/abaqus_fric.f90', '*'): HOST,
    ('src/adapters/abaqus_uinter.f90', '*'): HOST,
    ('src/adapters/abaqus_umat.f90', '*'): HOST,
    ('src/adapters/abaqus_vfric.f90', '*'): HOST,
    ('src/adapters/abaqus_vfriction.f90', '*'): HOST,
    ('src/adapters/abaqus_vuinter.f90', '*'): HOST,
    ('src/adapters/calculix_umat.f90', '*'): HOST,
    ('src/adapters/entry_fric.f90', '*'): HOST,
    ('src/adapters/entry_uinter.f90', '*'): HOST,
    ('src/adapters/entry_umat.f90', '*'): HOST,
    ('src/adapters/entry_vfric.f90', '*'): HOST,
    ('src/adapters/entry_vfriction.f90', '*'): HOST,
    ('src/adapters/entry_vuinter.f90', '*'): HOST,
    ('src/adapters/kratos_umat.f90', '*'): HOST,
    ('tests/unit/abaqus_explicit_calls.f90', '*'): HOST,
    ('tests/unit/abaqus_standard_calls.f90', '*'): HOST,
    ('tests/unit/calculix_calls.f90', '*'): HOST,
    ('tests/unit/kratos_calls.f90', '*'): HOST,
    ('driver/system/lapack_interface.f90', 'dgeev'): LAPACK,
    ('src/friction_c.f90', '*'): C,
    ('src/friction_c_point.f90', '*'): C,
    ('src/friction_mod.f90', 'friction_update_frame'): PUBLISHED,
    ('src/friction_mod.f90', 'friction_tangential'): PUBLISHED,
    ('src/friction_mod.f90', 'update_arrays_batch'): BOUNDS,
    ('src/friction_mod.f90', 'slip_rates_of_arrays'): BOUNDS,
    ('src/friction_batch.f90', 'update_arrays_batch'): BOUNDS,
    ('src/friction_batch.f90', 'update_range'): BOUNDS,
    ('src/friction_batch.f90', 'update_lanes'): BOUNDS,
    ('src/friction_batch.f90', 'update_copies'): BOUNDS,
    ('src/friction_points.f90', 'update_transposed'): BOUNDS,
    ('src/friction_slip_rate.f90', 'slip_rates_of_arrays'): BOUNDS,
    ('src/friction_slip_rate.f90', 'try_kernel'): BOUNDS,
    ('src/friction_batch.f90', 'subloading_kernel'): KERNEL,
    ('src/friction_batch.f90', 'call_kernel'): KERNEL,
    ('src/friction_slip_rate.f90', 'slip_rate_kernel'): KERNEL,
    ('src/friction_slip_rate_kernel.f90', 'slip_rates_of_block'): KERNEL,
    ('tests/unit/test_slip_rate_kernel.pf', 'slip_rate_kernel'): KERNEL,
    ('tests/unit/test_subloading_kernel.pf', 'subloading_kernel'): KERNEL,
    ('src/friction_subloading_kernel.f90', 'update_block'): KERNEL,
    ('src/friction_subloading_kernel.f90', 'finish'): LOOPS,
    ('src/lanes/friction_rate_state_lanes.f90', 'step'): LOOPS,
    ('src/adapters/friction_explicit.f90', 'tangential'): ADAPTER,
    ('src/adapters/friction_finite_layer.f90', 'finite_layer_update'): ADAPTER,
    ('src/adapters/friction_host.f90', 'host_update'): ADAPTER,
    ('src/adapters/friction_host.f90', 'host_tangential'): ADAPTER,
    ('src/adapters/friction_host.f90', 'interface_update'): ADAPTER,
    ('src/adapters/friction_layer.f90', 'layer_update'): ADAPTER,
    ('src/adapters/friction_layer.f90', 'perturb_layer'): ADAPTER,
    ('tests/unit/test_laws_abaqus_explicit.pf', 'compare_vfric'): ADAPTER,
    ('driver/model/contact_forces.f90', 'friction_forces'): WORK,
    ('driver/model/contact_forces.f90', 'forces_on_part'): WORK,
    ('driver/stepping/explicit_pairs.f90', 'explicit_step'): WORK,
    ('driver/stepping/rosenbrock.f90', 'rosenbrock_step'): WORK,
    ('driver/stepping/rosenbrock.f90', 'differentiate'): WORK,
    ('bench/explicit_slider.f90', 'solve_explicitly'): 'one integrator from its start to its end, for a bench',
    ('bench/bars.f90', 'write_bars'): PARTS,
    ('driver/stepping/adaptive_steps.f90', 'step'): PARTS,
    ('driver/verbs/point_study.f90', 'follow_path'): PARTS,
    ('driver/verbs/sweep.f90', 'run_all'): PARTS,
    ('tests/soak/path_checks.f90', 'check_first_root'): PARTS,
    ('tests/soak/path_checks.f90', 'sliding_fault'): PARTS,
    ('tests/unit/test_batch.pf', 'bad_points_harm_only_themselves'): PARTS,
}

PREFIX = r'(?:(?:pure|elemental|impure|recursive|module|integer|real|logical|character|type)(?:\s*\([^)]*\))?\s+)*'
START = re.compile(r'^\s*(end\s+)?' + PREFIX + r'(subroutine|function|procedure)\s+(\w+)(?:\s*\(([^)]*)\))?')
INTERFACE = re.compile(r'^\s*(end\s+)?(?:abstract\s+)?interface\b')


def statements(text):
    """Statements without comments, each with the number of lines it takes."""
    statement, lines = '', 0
    for line in text.splitlines():
        lines += 1
        code = re.sub(r"'[^']*'|\"[^\"]*\"", '', line).split('!')[0].rstrip()
        statement += re.sub(r'^\s*&', '', code) if statement else code
        if statement.endswith('&'):
            statement = statement[:-1]
            continue
        yield statement, lines
        statement, lines = '', 0


def procedures(text):
    """Name, lines and arguments of each procedure; of those of interfaces the lines are no matter."""
    stack = []
    in_interface = False
    for statement, lines in statements(text):
        interface = INTERFACE.match(statement)
        if interface:
            in_interface = not interface.group(1)
        for outer in stack:
            outer[1] += lines
        found = START.match(statement)
        if not found or re.match(r'^\s*(module\s+)?procedure\s*(,|::|\()', statement):
            continue
        if found.group(1):
            if stack:
                yield stack.pop()
        else:
            if in_interface and found.group(2) == 'procedure':
                continue   # a list of names
            arguments = [name.strip() for name in (found.group(4) or '').split(',') if name.strip()]
            stack.append([found.group(3), lines, len(arguments) - (arguments[:1] == ['self'])])


def apart(text):
    """What commas outside of parentheses part."""
    depth, parts = 0, ['']
    for letter in text:
        depth += (letter == '(') - (letter == ')')
        if letter == ',' and not depth:
            parts.append('')
        else:
            parts[-1] += letter
    return [part.strip() for part in parts]


def declared(line):
    """Name, and bounds and length, of each variable of a declaration."""
    kind, entities = line.split('::', 1)
    length = re.search(r'\blen *= *(.*)\)', apart(kind)[0])
    for entity in apart(entities):
        name, _, bounds = entity.split('=')[0].partition('(')
        yield name.strip(), bounds + ' ' + (length.group(1) if length else '')


def calls_in_interfaces(text):
    """Arguments and results of a type's procedures whose bounds or length call a function, but for one of a constant."""
    lines = [re.sub(r'\s+', ' ', statement).strip() for statement, _ in statements(text)]
    of_types = set()
    for line in lines:
        if re.match(r'procedure\b.*::', line):
            of_types |= {part.split('=>')[-1].strip() for part in apart(line.split('::')[1])}
            of_types |= set(re.findall(r'^procedure *\( *(\w+) *\)', line))   # an interface by its name
    constants = {name for line in lines if re.match(r'[^:]*\bparameter\b.*::', line) for name, _ in declared(line)}
    own = set()
    for line in lines:
        start = START.match(line)
        if start or line == 'contains':
            own = set()
        if start and not start.group(1) and start.group(3) in of_types:
            result = re.search(r'\bresult *\( *(\w+)', line)
            own = set(re.findall(r'\w+', start.group(4) or '')) | {result.group(1) if result else start.group(3)}
        elif own and '::' in line:
            for name, bounds in declared(line):
                if name in own and set(re.findall(r'\b\w+ *\( *(\w+)', bounds)) - constants:
                    yield name


def check(root):
    faults, used = [], set()
    for path in sorted(path for folder in FOLDERS for path in (root / folder).rglob('*')):
        if path.suffix not in ('.f90', '.pf'):
            continue
        file = path.relative_to(root).as_posix()
        text = path.read_text()
        faults += [f'{file}: bounds or length of {name}, of a procedure of a type, call a function'
                   for name in calls_in_interfaces(text)]
        for name, lines, arguments in procedures(text):
            wrong = []
            if lines > LONGEST:
                wrong.append(f'has {lines} lines, more than {LONGEST}')
            if arguments > WIDEST:
                wrong.append(f'takes {arguments} arguments, more than {WIDEST}')
            allowed = {(file, name), (file, '*')} & set(EXCEPTIONS)
            if wrong:
                used |= allowed
                if not allowed:
                    faults.append(f'{file}: {name} ' + ' and '.join(wrong))
    faults += [f'{file}: {name} needs no exception any more' for file, name in set(EXCEPTIONS) - used]
    return faults


def main():
    here = pathlib.Path(__file__).resolve().parent.parent
    faults = check(pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else here)
    print('\n'.join(faults) if faults else 'procedures: none is too long, none takes too many arguments')
    sys.exit(bool(faults))


if __name__ == '__main__':
    main()
