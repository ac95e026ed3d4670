"""All mutants of a source in one: each statement with its mutants, among which a number chooses when a test runs.

A statement becomes a choice of its variants. With the number -1 the original is taken, and notes are made of which mutants'
statements were reached, and of which would have had another value there: no test notices a mutant that has the same value.
"""
import re
import subprocess

TRY_AGAIN = 12


class Statement:
    """Lines first to last of a source, joined, and its mutants."""

    def __init__(self, first, last, lines):
        self.first, self.last, self.lines = first, last, lines
        self.mutants = []

    def text(self, mutant=None):
        lines = list(self.lines)
        if mutant is not None:
            lines[mutant.number - self.first] = mutant.new
        return ' '.join(uncommented(line).strip().strip('&').strip() for line in lines).strip()


def blanked(line):
    return re.sub(r"'[^']*'|\"[^\"]*\"", lambda text: '#' * len(text.group()), line)


def uncommented(line):
    return line[:len(blanked(line).split('!')[0])].rstrip()


def statements_of(text):
    lines, begun = text.splitlines(), 0
    for end, line in enumerate(lines):
        code = uncommented(line).rstrip()
        if not code.endswith('&') and not (not code and end > begun):   # a comment within a statement
            yield Statement(begun + 1, end + 1, lines[begun:end + 1])
            begun = end + 1


def closing(text, start):
    """Where the parenthesis at `start` is closed."""
    depth = 0
    for place in range(start, len(text)):
        depth += {'(': 1, ')': -1}.get(blanked(text)[place], 0)
        if depth == 0:
            return place
    raise ValueError(text)


def assignment(text):
    """The two sides of an assignment, or none."""
    depth, code = 0, blanked(text)
    for place, letter in enumerate(code):
        depth += {'(': 1, ')': -1, '[': 1, ']': -1}.get(letter, 0)
        if letter == '=' and depth == 0:
            if code[place + 1] in '=>' or code[place - 1] in '/<>=':
                return None
            return text[:place].strip(), text[place + 1:].strip()
    return None


def one_line_if(text):
    """Condition and statement of `if (..) statement`, or none."""
    if not text.startswith('if ('):
        return None
    end = closing(text, 3)
    rest = text[end + 1:].strip()
    return None if not rest or rest == 'then' else (text[4:end], rest)


def value_probe(original, changed, number):
    """Statements that note a mutant of which the value is another."""
    note = f'call mutant_differs({number})'
    if changed == 'continue':
        parts = one_line_if(original)
        return f'if ({parts[0]}) {note}'
    before, after = one_line_if(original), one_line_if(changed)
    if before and after:
        if before[0] != after[0]:
            return f'if (({before[0]}) .neqv. ({after[0]})) {note}'
        inner = value_probe(before[1], after[1], number)
        return f'if ({before[0]}) then\n{inner}\nend if'
    before, after = assignment(original), assignment(changed)
    if before and after and before[0] == after[0]:
        return f'if (mutant_other({before[1]}, {after[1]})) {note}'
    return note


class Switched:
    """A source with its mutants; `numbers` are those of the mutants in it, the others have to be compiled alone."""

    def __init__(self, source, mutants, first_number):
        self.source, self.text = source, source.read_text()
        self.number_of = {mutant: first_number + place for place, mutant in enumerate(mutants)}
        self.no_probe, self.alone, self.plain = set(), set(), set()   # mutants twice, statements
        self.statements = list(statements_of(self.text))
        by_line = {line: statement for statement in self.statements for line in range(statement.first, statement.last + 1)}
        for mutant in mutants:
            by_line[mutant.number].mutants.append(mutant)

    def numbers(self):
        return {self.number_of[mutant]: mutant for statement in self.statements if statement.first not in self.plain
                for mutant in statement.mutants if mutant not in self.alone}

    def write(self, changed=None):
        """The lines, and for each whom it belongs to: a statement, a mutant, whether it is a probe; or with one mutant for good."""
        out = []
        for statement in self.statements:
            mutants = [mutant for mutant in statement.mutants if mutant not in self.alone]
            lines = None
            if changed in statement.mutants:
                lines = [(statement.text(changed), None, False)]
            elif mutants and statement.first not in self.plain:
                lines = self.variants(statement, mutants)
            if lines is None:
                self.plain.add(statement.first)
                lines = [(line, None, False) for line in statement.lines]
            out += [(line, statement, mutant, probe) for line, mutant, probe in lines]
            code = uncommented(statement.lines[0])
            if re.match(r'(module|submodule *\(\w+\)|subroutine|program) +\w+', code) and not code.startswith('module procedure'):
                out.append(('use mutant_switch_kernel', statement, None, False))
        return out

    def variants(self, statement, mutants):
        text = statement.text()
        number = {mutant: self.number_of[mutant] for mutant in mutants}
        first, last = min(number.values()), max(number.values())
        if '::' in blanked(text) or re.match(r'(where|forall|associate|select|case|class|type|allocate|end)\b', text):
            return None
        condition = re.match(r'((?:\w+ *: *)?(?:else if|if|do while) \()(.*)\) *(then|)$', text)
        if condition and (condition.group(3) or 'while' in condition.group(1)):
            return self.conditions(condition, statement, mutants)
        if re.match(r'(\w+ *: *)?do\b', text):
            return self.loop(text, statement, mutants)
        out = [('select case (mutant)', None, False)]
        for mutant in mutants:
            out += [(f'case ({number[mutant]})', mutant, False), (statement.text(mutant), mutant, False)]
        out += [('case (-1)', None, False), (f'call mutant_reached({first}, {last})', None, False)]
        for mutant in mutants:
            if mutant in self.no_probe:
                out.append((f'call mutant_differs({number[mutant]})', None, False))
            else:
                probe = f'if (mutant_may({number[mutant]})) then\n{value_probe(text, statement.text(mutant), number[mutant])}\nend if'
                out += [(line, mutant, True) for line in probe.split('\n')]
        return [*out, (text, None, False), ('case default', None, False), (text, None, False), ('end select', None, False)]

    def conditions(self, condition, statement, mutants):
        number = {mutant: self.number_of[mutant] for mutant in mutants}
        first, last = min(number.values()), max(number.values())
        start, original, then = condition.groups()
        inner = {}
        for mutant in mutants:
            text = statement.text(mutant)
            if not (text.startswith(start) and text.endswith(f') {then}'.rstrip())):
                return None
            inner[mutant] = text[len(start):].rstrip().removesuffix('then').rstrip()[:-1]
        out = [(f'{start} &', None, False), (f'(mutant == -1 .and. mutant_seen({first}, {last})) .or. &', None, False)]
        for mutant in mutants:
            differs = '.true.' if mutant in self.no_probe else f'({original}) .neqv. ({inner[mutant]})'
            out.append((f'(mutant == -1 .and. mutant_may({number[mutant]}) .and. mutant_noted({number[mutant]}, logical({differs}, mutant_bool))) .or. &', mutant, True))
            out.append((f'(mutant == {number[mutant]} .and. ({inner[mutant]})) .or. &', mutant, False))
        out.append((f'((mutant < {first} .or. mutant > {last}) .and. ({original}))) {then}', None, False))
        return out

    def loop(self, text, statement, mutants):
        start, bounds = re.match(r'((?:\w+ *: *)?do \w+ = )(.*)', text).groups()
        parts = top_level(bounds)
        number = {mutant: self.number_of[mutant] for mutant in mutants}
        for mutant in mutants:
            if not statement.text(mutant).startswith(start):
                return None
            changed = top_level(statement.text(mutant)[len(start):])
            for place, part in enumerate(changed):
                if part != top_level(bounds)[place]:
                    parts[place] = f'merge({part}, {parts[place]}, mutant == {number[mutant]})'
        first, last = min(number.values()), max(number.values())
        return [(f'if (mutant == -1) call mutant_reached({first}, {last})', None, False),
                *((f'if (mutant == -1) call mutant_differs({number[mutant]})', None, False) for mutant in mutants),
                (start + ', '.join(parts), None, False)]

    def settle(self, folder):
        """Compiles and puts aside what does not compile, until the rest does."""
        for _ in range(TRY_AGAIN):
            lines = self.write()
            target = folder / self.source.name
            target.write_text('\n'.join(line for line, *_ in lines) + '\n')
            found = subprocess.run(['gfortran', '-std=f2008', '-fopenmp', '-w', '-O0', '-c', '-o', 'settled.o', '-ffree-line-length-none', '-fmax-errors=0',
                                    '-J', str(folder), str(target)], cwd=folder, text=True, capture_output=True)
            if not found.returncode:
                return self
            wrong = {int(it) for it in re.findall(rf'{re.escape(target.name)}:(\d+):', found.stderr)}
            if not wrong:
                raise SystemExit(f'{target}: {found.stderr}')
            for line in wrong:
                text, statement, mutant, probe = lines[line - 1]
                if probe and mutant not in self.no_probe:
                    self.no_probe.add(mutant)
                elif mutant is not None:
                    self.alone.add(mutant)
                else:
                    self.plain.add(statement.first)
        raise SystemExit(f'{target}: {found.stderr}')


def top_level(text):
    """The parts between commas that no parenthesis holds."""
    parts, depth = [''], 0
    for letter in text:
        depth += {'(': 1, ')': -1, '[': 1, ']': -1}.get(letter, 0)
        if letter == ',' and depth == 0:
            parts.append('')
        else:
            parts[-1] += letter
    return [part.strip() for part in parts]
