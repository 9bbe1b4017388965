"""A disc, a pad and a beam on few elements, with friction: the scene of several tests, but for what they ask of it."""

SCENE = """model: {source: rig}
parts: disc,pad,beam
rig: {disc_elements: "6,24,1", pad_elements: "2,2,2", beam_elements: 3}
beam: {young: 2.1e11, poisson: 0.3, density: 7800}
disc: {young: 2.1e11, poisson: 0.3, density: 7800}
pad: {young: 8e9, poisson: 0.3, density: 2500}
supports: hub
hub: {set: disc_inner, fix: xyz}
springs: rows
rows: {set: beam_rows, stiffness: "0,8e6,0"}
loads: press
press: {set: beam_top, force: "0,0,-100"}
contacts: contact
contact: {surfaces: "pad_face,disc_face", kn: 1e8, mu: 0.9, slip: "0,1,0", speed: 1}
"""
