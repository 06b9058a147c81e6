"""The scenes whose pages browse_report.py opens."""

PLANE = """
title: "Two <b>blocks</b> & a {{wall}} </script>"
space: plane_strain
grid: {size: [12 mm, 8 mm], cell: 0.5 mm}
time: {end: 60 us}
materials:
  soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}
  stiff: {model: neo_hookean, density: 2400 kg/m^3, bulk: 160 MPa, shear: 60 MPa}
bodies:
  - {name: left, box: {from: [1 mm, 2 mm], to: [5 mm, 6 mm]}, material: soft, velocity: [30 m/s, 0 m/s]}
  - {name: right, box: {from: [5.5 mm, 1 mm], to: [10 mm, 6 mm]}, material: stiff, velocity: [-30 m/s, 0 m/s]}
cracks: [{name: slit, body: right, line: [[7 mm, 3 mm], [8 mm, 4.5 mm]]}]
output: {frames: 6, history: 30, picture: von_mises}
"""
SPACE = """
title: Two balls
space: 3d
grid: {size: [12 mm, 8 mm, 8 mm], cell: 1 mm}
time: {end: 60 us}
materials: {soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: left, sphere: {centre: [3.5 mm, 4 mm, 4 mm], radius: 2 mm}, material: soft, velocity: [30 m/s, 0, 0]}
  - {name: right, sphere: {centre: [8 mm, 4 mm, 4 mm], radius: 2 mm}, material: soft, velocity: [-30 m/s, 0, 0]}
output: {frames: 4, history: 10}
"""
FAILING = """
title: A block that leaves the grid
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm}
time: {end: 1 ms}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies: [{name: missile, box: {from: [2 mm, 4 mm], to: [4 mm, 6 mm]}, material: m, velocity: [40 m/s, 0 m/s]}]
output: {frames: 8, history: 10}
"""
AXIS = """
title: A ball on the axis
space: axisymmetric
grid: {size: [8 mm, 12 mm], cell: 0.5 mm}
time: {end: 200 us}
materials: {soft: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: ball, disk: {centre: [0, 5 mm], radius: 3 mm}, material: soft, velocity: [0, -20 m/s]}
  - {name: floor, box: {from: [0, 0.5 mm], to: [6 mm, 1.5 mm]}, material: soft}
boundaries: {left: symmetry, bottom: wall, top: {piston: 5 m/s, direction: down}}
output: {frames: 5, history: 10, picture: none}
"""
OUTFLOW = """
title: One of two blocks flies out
space: plane_strain
grid: {size: [10 mm, 10 mm], cell: 1 mm, leaving: outflow}
time: {end: 400 us}
materials: {m: {model: neo_hookean, density: 1200 kg/m^3, bulk: 80 MPa, shear: 30 MPa}}
bodies:
  - {name: missile, box: {from: [2 mm, 4 mm], to: [4 mm, 6 mm]}, material: m, velocity: [40 m/s, 0]}
  - {name: rest, box: {from: [0, 0], to: [4 mm, 2 mm]}, material: m}
output: {frames: 8, history: 10}
"""
