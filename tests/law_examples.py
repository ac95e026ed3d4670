"""Every law with constants for tests: law_constants.csv, for N, mm and s, for pressures of some N/mm^2 and slips of some
hundredths of a millimetre. A law that is added gets its lines there.
"""
import csv
import ctypes
import os
import pathlib


class LawFacts(ctypes.Structure):
    """As in include/friction.h."""

    _fields_ = [('name', ctypes.c_char * 24), ('internal', ctypes.c_char * 16), ('internal_unit', ctypes.c_char * 8),
                ('has_internal', ctypes.c_int), ('constants', ctypes.c_int)]


class ConstantFacts(ctypes.Structure):
    """As in include/friction.h."""

    _fields_ = [('name', ctypes.c_char * 24), ('unit', ctypes.c_char * 8), ('meaning', ctypes.c_char * 72),
                ('rule', ctypes.c_char * 104), ('default_text', ctypes.c_char * 24), ('words', ctypes.c_char * 72),
                ('lower', ctypes.c_double), ('upper', ctypes.c_double), ('optional', ctypes.c_int), ('choice', ctypes.c_int)]


def constants_by_law():
    """{law: {constant: value}}; constants that every law has stand under 'every'."""
    found = {}
    with open(pathlib.Path(__file__).with_name('law_constants.csv'), newline='', encoding='utf-8') as file:
        for row in csv.DictReader(file):
            found.setdefault(row['law'], {})[row['constant']] = float(row['value'])
    return found


class Law:
    """A law as the library tells of it, and its constants for tests."""

    def __init__(self, library, number, known):
        facts, constant = LawFacts(), ConstantFacts()
        library.friction_get_law(number, ctypes.byref(facts))
        self.number, self.name = number, facts.name.decode()
        self.internal = (facts.internal.decode(), facts.internal_unit.decode()) if facts.has_internal else None
        self.facts = []   #: of its constants, in the order of `props`
        for place in range(facts.constants):
            library.friction_get_constant(number, place, ctypes.byref(constant))
            self.facts.append(ConstantFacts.from_buffer_copy(constant))
        self.names = [facts.name.decode() for facts in self.facts]
        self.needed = sum(not facts.optional for facts in self.facts)
        self.values = {**known['every'], **known[self.name], 'law': float(number)}

    def props(self, *options, **changed):
        """The constants that have no default; with options, those up to the last of them, the others switched off."""
        values = {**self.values, **changed}
        last = max([self.needed - 1, *(self.names.index(name) for name in options)])
        first_option = self.names.index('tau_max')
        return [0.0 if place >= first_option and name not in options and name not in changed else values[name]
                for place, name in enumerate(self.names[:last + 1])]

    @property
    def camel(self):
        """'RateAndState' for 'rate_and_state'."""
        return ''.join(word.capitalize() for word in self.name.split('_'))


def laws():
    """All laws of the library STICKSLIP_LIBRARY, by name."""
    library = ctypes.CDLL(os.environ['STICKSLIP_LIBRARY'])
    known = constants_by_law()
    found = [Law(library, number, known) for number in range(1, library.friction_law_count() + 1)]
    return {law.name: law for law in found}
