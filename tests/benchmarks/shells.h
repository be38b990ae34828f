#pragma once
/// The tables of Froehlich and Botsch, "Example-Driven Deformations Based on Discrete Shells", 2011, beside today's.

#include <map>
#include <string>

namespace sinew::benchmarks {

using Tables = std::map<std::string, std::map<std::string, double>>;

/// Print tables of shells alone, and of shells between poses; the figures by row and name, in milliseconds where they
/// are times.
Tables print_shells();
Tables print_poses();

/// The cases of Botsch and Sorkine, at all vertices and at 1,000; a cylinder that is stretched (Figure 4).
void print_shell_minima(Tables& figures);
/// Table 1: a Gauss-Newton step, coarse and fine, what is made beforehand, the fine surface, and a preview of it.
void print_shell_times(Tables& figures);
/// Table 2: the Hausdorff distance between interpolations on the coarse mesh and on all vertices.
void print_shell_distances(Tables& figures);
/// Inverse kinematics towards a pose that is not among the examples, by shells and by MeshIk.
void print_held_out(Tables& figures);

}  // namespace sinew::benchmarks
