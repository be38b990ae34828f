"""graph_oracle.py REFERENCE CASE NODES WEIGHTS EDGES: the energy that an independent implementation in numpy (the folder
REFERENCE, its graph.py) reaches on a case, with the nodes, weights and edges given. WEIGHTS: "point node weight" a line;
EDGES: "node node" a line. Which of several equally far nodes is the last of the k is an accident, so both sides must be
told the same influences. Prints iterations and energy."""
import sys

import numpy as np

sys.path.insert(0, sys.argv[1])
import graph  # noqa: E402
from case import Case  # noqa: E402

case = Case(sys.argv[2])
nodes = np.loadtxt(sys.argv[3], dtype=int)
rows = np.loadtxt(sys.argv[4])
edges = np.loadtxt(sys.argv[5], dtype=int)

point, node, weight = rows[:, 0].astype(int), rows[:, 1].astype(int), rows[:, 2]
k = 4
w, i = np.zeros((len(case.v), k)), np.full((len(case.v), k), -1)
at = np.zeros(len(case.v), int)
for p, n, x in zip(point, node, weight):
    w[p, at[p]], i[p, at[p]] = x, n
    at[p] += 1
i = np.where(i < 0, i[:, :1], i)  # empty places follow the first node, with weight zero


graph.weights = lambda v, g, neighbours: (w, i)
unique = np.unique


def unique_rows(a, *args, **kwargs):
    return edges if kwargs.get("axis") == 0 and np.shape(a) == i.shape else unique(a, *args, **kwargs)


graph.np.unique = unique_rows
g = graph.Graph(case, nodes)
graph.np.unique = unique
used = unique(node[np.isin(point, case.fixed)])
g.free[:] = True
g.free[used] = False
X, F = g.solve(g.rest(), eps=1e-10)
print(len(F) - 1, "%.12g" % F[-1])
