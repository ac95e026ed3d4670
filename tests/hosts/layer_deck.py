"""Decks for CalculiX: two elastic blocks of n x n elements and a thin layer of friction between them."""

CONTROLS = '*CONTROLS, PARAMETERS=FIELD\n1.E-6, 1.E-6, , , 1.E-6\n'
UNEVEN = '{uneven}'   # the pressing displacements of the upper face, put in by `deck`
PRINT = '*EL PRINT, ELSET=LAYER\nS, E, SDV\n'
PRESSED = (f'*STEP, INC=2000\n*STATIC\n0.1, 1., 1.E-9, 0.1\n{CONTROLS}*BOUNDARY\nTOP, 1, 2\n{UNEVEN}\n{PRINT}'
           '*END STEP\n')
SHEARED = ''.join(f'*STEP, INC=2000\n*STATIC\n0.1, 1., 1.E-9, 0.1\n{CONTROLS}*BOUNDARY\nTOP, 1, 1, {x}\nTOP, 2, 2, {y}\n'
                  f'{UNEVEN}\n{PRINT}*END STEP\n' for x, y in ((0.04, 0.01), (0.0, 0.02)))


def dragged(option, slip):
    """Pressed by 0.003 in 0.1 s, then dragged by `slip` in 1 s; `option` of *STEP."""
    return (f'*AMPLITUDE, NAME=PR\n0., 0., 0.1, 1., 1.1, 1.\n*AMPLITUDE, NAME=SX\n0., 0., 0.1, 0., 1.1, 1.\n'
            f'*STEP{option}, INC=500\n*STATIC\n0.02, 1.1, 1.E-6, 0.02\n{CONTROLS}*BOUNDARY, AMPLITUDE=SX\nTOP, 1, 1, {slip}\n'
            '*BOUNDARY, AMPLITUDE=PR\nTOP, 3, 3, -0.003\n*BOUNDARY\nTOP, 2, 2\n*NODE PRINT, NSET=TOP, TOTALS=ONLY\nRF\n'
            '*END STEP\n')


def deck(n, layer, material, steps, length=20.0, height=10.0, young=1e4, poisson=0.3):
    """The model, fixed at its bottom, and the steps; `material` is the friction layer's *USER MATERIAL."""
    levels = [0.0, height, height + layer[0], 2 * height + layer[0]]

    def node(i, j, level):
        return (level * (n + 1) + j) * (n + 1) + i + 1

    def places(level):
        return [(i, j, node(i, j, level)) for j in range(n + 1) for i in range(n + 1)]

    lines = ['*NODE, NSET=ALL']
    for level, z in enumerate(levels):
        lines += [f'{k}, {length * i / n!r}, {length * j / n!r}, {z!r}' for i, j, k in places(level)]
    element = 0
    for level in range(3):
        lines.append(f'*ELEMENT, TYPE=C3D8, ELSET={"LAYER" if level == 1 else "BLOCKS"}')
        for j in range(n):
            for i in range(n):
                element += 1
                corners = [node(a, b, k) for k in (level, level + 1)
                           for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1))]
                lines.append(', '.join(map(str, [element, *corners])))
    for name, level in (('BOT', 0), ('TOP', 3)):
        lines += [f'*NSET, NSET={name}'] + [f'{k},' for _, _, k in places(level)]
    lines += ['*MATERIAL, NAME=BLOCK', '*ELASTIC', f'{young}, {poisson}', '*SOLID SECTION, ELSET=BLOCKS, MATERIAL=BLOCK',
              '*MATERIAL, NAME=@ABAQUS_STICKSLIP', material.strip(), '*DEPVAR', '8',
              '*SOLID SECTION, ELSET=LAYER, MATERIAL=@ABAQUS_STICKSLIP', '*BOUNDARY', 'BOT, 1, 3']
    uneven = '\n'.join(f'{k}, 3, 3, {-(0.010 + 0.012 * i / n - 0.004 * j / n):.6g}' for i, j, k in places(3))
    return '\n'.join(lines) + '\n' + steps.replace(UNEVEN, uneven)
