"""Two blocks in OpenGeoSys with a thin layer of friction between them: pressed, sheared, reversed, lifted, slid on.

    pip install ogs
    python two_blocks.py LIBSTICKSLIP_MGIS.so [FOLDER]

writes meshes and project of a model in the plane, runs it, and prints the force on the upper block. Lengths in mm,
stresses in N/mm^2. In the plane the layer's normal is y, in space z.
"""
import os
import pathlib
import re
import subprocess
import sys
import sysconfig

LENGTH, HEIGHT, THICKNESS = 20.0, 10.0, 0.1
LAYER = {'Thickness': THICKNESS, 'InPlaneModulus': 1.0}
SUBLOADING = {'NormalStiffness': 1000, 'TangentialStiffness': 800, 'StaticFriction': 0.45, 'KineticFriction': 0.25,
              'AdhesionBreakingExponent': 8, 'AdhesionFormingExponent': 0.2, 'SubloadingExponent': 60}
DT, STEPS = 0.05, 160   # step [s]; steps
# time, and what part of the pressing and of the shear displacements (mm) has been reached
PROGRAMME = [(0, 0, 0, 0), (0.5, 1, 0, 0), (1.5, 0.5, 0.05, 0.01), (2.5, 1, 0.1, 0.03), (3, 1, 0.1, 0.03),
             (4, 1.1, 0.05, 0.05), (4.2, -0.3, 0.05, 0.05), (4.5, -0.3, 0.08, 0.05), (5, 1.2, 0.1, 0.05),
             (8, 1.2, 0.4, 0.15)]
LINE, QUADRILATERAL, HEXAHEDRON = 3, 9, 12   # kinds of cells in VTK


def array(kind, name, values, components=1):
    return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="ascii">'
            + ' '.join(map(repr, values)) + '</DataArray>')


def write_mesh(path, points, cells, kind, point_data='', cell_data=''):
    """A mesh in VTK's XML format."""
    ends = [len(cells[0]) * (k + 1) for k in range(len(cells))]
    path.write_text(
        '<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian" header_type="UInt64"><UnstructuredGrid>'
        f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}"><PointData>{point_data}</PointData>'
        f'<CellData>{cell_data}</CellData><Points>'
        + array('Float64', 'Points', [x for point in points for x in point], 3) + '</Points><Cells>'
        + array('Int64', 'connectivity', [node for cell in cells for node in cell]) + array('Int64', 'offsets', ends)
        + array('UInt8', 'types', [kind] * len(cells)) + '</Cells></Piece></UnstructuredGrid></VTKFile>')


class TwoBlocks:
    """Elements n along x (and n along y in space), one through each block and one through the layer."""

    def __init__(self, library, behaviour, constants, n=10, dimension=2):
        self.library, self.behaviour, self.n, self.dimension = library, behaviour, n, dimension
        self.constants = {**LAYER, **constants}
        self.levels = [0.0, HEIGHT, HEIGHT + THICKNESS, 2 * HEIGHT + THICKNESS]
        self.across = n if dimension == 3 else 0

    def node(self, i, j, level):
        return (level * (self.across + 1) + j) * (self.n + 1) + i

    def face(self, i, j, level):
        """The nodes of one element's face on a level."""
        if self.dimension == 2:
            return [self.node(i, 0, level), self.node(i + 1, 0, level)]
        return [self.node(a, b, level) for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))]

    def columns(self):
        return [(i, j) for j in range(max(1, self.across)) for i in range(self.n)]

    def write_meshes(self, folder):
        step = LENGTH / self.n
        points = [(i * step, z, 0.0) if self.dimension == 2 else (i * step, j * step, z)
                  for z in self.levels for j in range(self.across + 1) for i in range(self.n + 1)]
        cells = []
        for level in range(3):
            for i, j in self.columns():
                low, high = self.face(i, j, level), self.face(i, j, level + 1)
                cells.append(low + (high[::-1] if self.dimension == 2 else high))
        kinds = (QUADRILATERAL, LINE) if self.dimension == 2 else (HEXAHEDRON, QUADRILATERAL)
        per_level = len(self.columns())
        material = [0] * per_level + [1] * per_level + [0] * per_level
        write_mesh(folder / 'blocks.vtu', points, cells, kinds[0], cell_data=array('Int32', 'MaterialIDs', material))
        for name, level, first in (('bottom', 0, 0), ('top', 3, 2 * per_level)):
            nodes = self.nodes_of(level)
            faces = [[node - nodes[0] for node in self.face(i, j, level)] for i, j in self.columns()]
            write_mesh(folder / f'{name}.vtu', [points[k] for k in nodes], faces, kinds[1],
                       array('UInt64', 'bulk_node_ids', nodes),
                       array('UInt64', 'bulk_element_ids', [first + k for k in range(per_level)]))

    def nodes_of(self, level):
        return [self.node(i, j, level) for j in range(self.across + 1) for i in range(self.n + 1)]

    def write_project(self, folder):
        d = self.dimension
        normal = d - 1
        shear = ['along', 'across'][:d - 1]
        conditions = ''.join(self.condition('bottom', k, 'zero') for k in range(d))
        conditions += ''.join(self.condition('top', k, name) for k, name in enumerate(shear))
        conditions += self.condition('top', normal, 'press')
        curves = ''.join(f'<curve><name>{name}</name><coords>{" ".join(str(row[0]) for row in PROGRAMME)}</coords>'
                         f'<values>{" ".join(str(row[k]) for row in PROGRAMME)}</values></curve>'
                         for k, name in ((1, 'pressing'), (2, 'along'), (3, 'across')))
        numbers = {**self.constants, 'E': 1e4, 'nu': 0.3, 'zero': 0.0, 'one': 1.0}
        parameters = ''.join(f'<parameter><name>{name}</name><type>Constant</type><value>{float(value)!r}</value></parameter>'
                             for name, value in numbers.items())
        parameters += ('<parameter><name>start</name><type>Constant</type><values>' + ' '.join('0' * d) + '</values></parameter>'
                       '<parameter><name>profile</name><type>Function</type>'
                       '<expression>-(0.010+0.012*x/20)</expression></parameter>')
        parameters += ''.join(f'<parameter><name>{name}</name><type>CurveScaled</type><curve>{curve}</curve>'
                              f'<parameter>{scale}</parameter></parameter>'
                              for name, curve, scale in (('press', 'pressing', 'profile'), ('along', 'along', 'one'),
                                                         ('across', 'across', 'one')))
        properties = ''.join(f'<material_property name="{name}" parameter="{name}"/>' for name in self.constants)
        medium = ''.join(f'<medium id="{k}"><phases><phase><type>Solid</type><properties><property><name>density</name>'
                         '<type>Constant</type><value>1</value></property></properties></phase></phases></medium>' for k in (0, 1))
        (folder / 'blocks.prj').write_text(f'''<?xml version="1.0" encoding="ISO-8859-1"?>
<OpenGeoSysProject>
<meshes><mesh>blocks.vtu</mesh><mesh>bottom.vtu</mesh><mesh>top.vtu</mesh></meshes>
<processes><process><name>SD</name><type>SMALL_DEFORMATION</type><integration_order>2</integration_order>
<constitutive_relation id="0"><type>LinearElasticIsotropic</type><youngs_modulus>E</youngs_modulus>
<poissons_ratio>nu</poissons_ratio></constitutive_relation>
<constitutive_relation id="1"><type>MFront</type><library>{self.library}</library><behaviour>{self.behaviour}</behaviour>
<material_properties>{properties}</material_properties></constitutive_relation>
<specific_body_force>{' '.join('0' * d)}</specific_body_force>
<process_variables><process_variable>displacement</process_variable></process_variables>
<secondary_variables><secondary_variable internal_name="sigma" output_name="sigma"/></secondary_variables></process></processes>
<media>{medium}</media>
<time_loop><processes><process ref="SD"><nonlinear_solver>newton</nonlinear_solver>
<convergence_criterion><type>Residual</type><norm_type>NORM2</norm_type><abstol>1e-6</abstol></convergence_criterion>
<time_discretization><type>BackwardEuler</type></time_discretization>
<time_stepping><type>FixedTimeStepping</type><t_initial>0</t_initial><t_end>{DT * STEPS}</t_end>
<timesteps><pair><repeat>{STEPS}</repeat><delta_t>{DT}</delta_t></pair></timesteps></time_stepping></process></processes>
<output><type>VTK</type><prefix>step</prefix><data_mode>Ascii</data_mode>
<timesteps><pair><repeat>{STEPS}</repeat><each_steps>1</each_steps></pair></timesteps>
<variables><variable>displacement</variable><variable>NodalForces</variable></variables></output></time_loop>
<parameters>{parameters}</parameters>
<curves>{curves}</curves>
<process_variables><process_variable><name>displacement</name><components>{d}</components><order>1</order>
<initial_condition>start</initial_condition><boundary_conditions>{conditions}</boundary_conditions></process_variable>
</process_variables>
<nonlinear_solvers><nonlinear_solver><name>newton</name><type>Newton</type><max_iter>30</max_iter>
<linear_solver>lu</linear_solver></nonlinear_solver></nonlinear_solvers>
<linear_solvers><linear_solver><name>lu</name><eigen><solver_type>SparseLU</solver_type></eigen></linear_solver></linear_solvers>
</OpenGeoSysProject>''')

    @staticmethod
    def condition(mesh, component, parameter):
        return (f'<boundary_condition><mesh>{mesh}</mesh><type>Dirichlet</type><component>{component}</component>'
                f'<parameter>{parameter}</parameter></boundary_condition>')

    def run(self, folder):
        """Newton iterations of each step. The fields of each step are left in the folder (`fields`)."""
        self.write_meshes(folder)
        self.write_project(folder)
        ogs = pathlib.Path(sysconfig.get_path('scripts')) / 'ogs'
        result = subprocess.run([ogs, 'blocks.prj'], cwd=folder, text=True, capture_output=True, check=False,
                                env={**os.environ, 'OMP_NUM_THREADS': '1'})
        if result.returncode != 0:
            raise RuntimeError((result.stdout + result.stderr)[-3000:])
        steps = re.split(r'Time step #\d+ started', result.stdout)[1:]
        return [len(re.findall(r'Iteration #\d+ started', step)) for step in steps]

    def fields(self, folder, step):
        """Displacements and forces at the nodes, a list of components each."""
        text = next(folder.glob(f'step_ts_{step}_t_*.vtu')).read_text()
        found = []
        for name in ('displacement', 'NodalForces'):
            values = [float(word) for word in re.search(rf'Name="{name}"[^>]*>([^<]*)<', text).group(1).split()]
            found.append([values[at:at + self.dimension] for at in range(0, len(values), self.dimension)])
        return found

    def force(self, folder, step):
        """On the upper block: along x (and y), and normal."""
        forces = self.fields(folder, step)[1]
        return [sum(forces[node][k] for node in self.nodes_of(3)) for k in range(self.dimension)]


def main():
    folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else 'two_blocks_out')
    folder.mkdir(exist_ok=True)
    blocks = TwoBlocks(pathlib.Path(sys.argv[1]).resolve(), 'StickSlipSubloadingLayer', SUBLOADING)
    iterations = blocks.run(folder)
    print(f'{len(iterations)} steps, {max(iterations)} Newton iterations at most')
    print('time [s]   shear [N/mm]   normal [N/mm]')
    for step in range(5, STEPS + 1, 5):
        print('{:8.2f} {:14.6f} {:15.6f}'.format(DT * step, *blocks.force(folder, step)))


if __name__ == '__main__':
    main()
