"""A loader of MFront behaviours (generic interface): reads the symbols that MGIS reads, with ctypes alone.

A behaviour is loaded under a modelling hypothesis; what a host would refuse is an error here.
"""
import ctypes

Address = ctypes.c_void_p
DIMENSION = {'Tridimensional': 3, 'PlaneStrain': 2, 'PlaneStress': 2, 'GeneralisedPlaneStrain': 2, 'Axisymmetrical': 2}
ROOM_FOR_MESSAGE = 512
SCALAR, STENSOR, VECTOR, TENSOR = range(4)


class State(ctypes.Structure):
    _fields_ = [(name, Address) for name in (
        'gradients', 'thermodynamic_forces', 'mass_density', 'material_properties', 'internal_state_variables',
        'stored_energy', 'dissipated_energy', 'external_state_variables')]


class Data(ctypes.Structure):
    _fields_ = [('error_message', ctypes.c_char_p), ('dt', ctypes.c_double), ('K', Address), ('rdt', Address),
                ('speed_of_sound', Address), ('s0', State), ('s1', State)]


def numbers(values):
    """An array for C, of one number at least."""
    values = list(values) or [0.0]
    return (ctypes.c_double * len(values))(*values)


class Result:
    """What an integration gives: the returned code, and the arrays of the state at the end."""

    def __init__(self, code, forces, state, tangent, rdt, energies, message):
        self.code, self.forces, self.state, self.tangent = code, forces, state, tangent
        self.rdt, self.energies, self.message = rdt, energies, message


class Behaviour:
    def __init__(self, library, name, hypothesis):
        self.library, self.name, self.hypothesis = ctypes.CDLL(str(library)), name, hypothesis
        if self.number('mfront_mkt') != 1 or self.number('api_version') != 1:
            raise ValueError(f'{name} is no behaviour of this interface')
        self.type, self.kinematic = self.number('BehaviourType'), self.number('BehaviourKinematic')
        if self.number('SymmetryType') != 0:
            raise ValueError(f'{name} is not isotropic')
        self.gradients, self.forces = self.typed('Gradients'), self.typed('ThermodynamicForces')
        self.variables = self.typed('InternalStateVariables')
        self.properties = self.names('MaterialProperties')
        if self.number('requiresStiffnessTensor'):
            self.number('ElasticSymmetryType')
            self.properties = ['YoungModulus', 'PoissonRatio', *self.properties]
        self.number('requiresThermalExpansionCoefficientTensor')
        has_temperature = self.find('TemperatureRemovedFromExternalStateVariables') is None or self.number(
            'TemperatureRemovedFromExternalStateVariables') == 1
        self.external = (['Temperature'] if has_temperature else []) + [name for name, _ in self.typed(
            'ExternalStateVariables')]
        blocks = self.names('TangentOperatorBlocks')
        self.blocks = list(zip(blocks[::2], blocks[1::2]))
        self.parameters = self.typed('Parameters')
        self.names('InitializeFunctions')
        self.names('PostProcessings')
        self.energies = self.number('ComputesInternalEnergy'), self.number('ComputesDissipatedEnergy')
        self.update = getattr(self.library, f'{name}_{hypothesis}')
        self.update.restype = ctypes.c_int
        self.size = sum(self.size_of(code) for _, code in self.gradients)
        self.state_size = sum(self.size_of(code) for _, code in self.variables)

    def find(self, symbol):
        """The address of B_H_symbol or else of B_symbol; None if there is neither."""
        for name in (f'{self.name}_{self.hypothesis}_{symbol}', f'{self.name}_{symbol}'):
            try:
                return ctypes.addressof(ctypes.c_char.in_dll(self.library, name))
            except ValueError:
                pass
        return None

    def address(self, symbol):
        found = self.find(symbol)
        if found is None:
            raise ValueError(f'{self.name}: no symbol {symbol}')
        return found

    def number(self, symbol):
        return ctypes.c_ushort.from_address(self.address(symbol)).value

    def text(self, symbol):
        return ctypes.c_char_p.from_address(self.address(symbol)).value.decode()

    def names(self, what):
        count = self.number('n' + what)
        return [name.decode() for name in (ctypes.c_char_p * count).from_address(self.address(what))] if count else []

    def typed(self, what):
        """Names and kinds of variables; the symbol of the kinds must exist even where there are none."""
        names, kinds = self.names(what), self.address(what + 'Types')
        return list(zip(names, (ctypes.c_int * len(names)).from_address(kinds) if names else []))

    def size_of(self, code):
        dimension = DIMENSION[self.hypothesis]
        return {SCALAR: 1, STENSOR: {2: 4, 3: 6}[dimension], VECTOR: dimension, TENSOR: {2: 5, 3: 9}[dimension]}[code & 7]

    def integrate(self, start, end, properties, state, dt, asked=4.0, largest_rdt=1.0, sound=None):
        """One call of the update: gradients at the start and at the end, material properties (a dict), internal state."""
        constants = numbers(properties[name] for name in self.properties)
        former = numbers([float('nan')] * len(self.properties))   # constants at the start, which may be others
        gradients = numbers(start), numbers(end)
        forces = numbers([0.0] * self.size), numbers([0.0] * self.size)
        states = numbers(state), numbers([float('nan')] * self.state_size)   # the end is not the start yet
        energies = [numbers([0.0]) for _ in range(4)]
        operator = numbers([asked] + [0.0 if 0.0 <= asked < 1.0 else 7.0] * (self.size**2 - 1))   # what stood there, stands there
        external, density, rdt = numbers([293.15] * len(self.external)), numbers([1.0]), numbers([largest_rdt])
        message = ctypes.create_string_buffer(ROOM_FOR_MESSAGE)
        speed = numbers([-1.0])

        def address(array):
            return ctypes.cast(array, Address).value

        data = Data(ctypes.cast(message, ctypes.c_char_p), dt, address(operator), address(rdt), address(speed))
        for k, side in enumerate((data.s0, data.s1)):
            side.gradients, side.thermodynamic_forces = address(gradients[k]), address(forces[k])
            side.mass_density, side.material_properties = address(density), address(constants if k else former)
            side.internal_state_variables = address(states[k])
            side.stored_energy, side.dissipated_energy = address(energies[2 * k]), address(energies[2 * k + 1])
            side.external_state_variables = address(external)
        code = self.update(ctypes.byref(data))
        if sound is not None:
            sound.append(speed[0])
        tangent = [list(operator[row * self.size:(row + 1) * self.size]) for row in range(self.size)]
        return Result(code, list(forces[1]), list(states[1]), tangent, rdt[0], (energies[2][0], energies[3][0]),
                      message.value.decode())
