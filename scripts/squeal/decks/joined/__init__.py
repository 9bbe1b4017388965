"""What joins nodes of a deck: couplings and rigid bodies, masses, springs between nodes, linear equations.

  groups.py     nodes that follow a reference node, rigidly or it them in the mean, and what any node moves as
  linear.py     linear equations, solved for displacements that follow others
  holds.py      reference nodes that are held, equations, supports in turned axes: as supports or equations of the scene
  entries.py    points, bushings and loads on points of the scene
  beams.py      beams and masses along one direction, as a superelement; frames.py the matrices of a beam
  springs.py    springs and dashpots of Abaqus
"""
