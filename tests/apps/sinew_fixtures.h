#pragma once
/// A small scan and an edit of it, as files.

#include <cmath>
#include <string>

namespace sinew {

/// An ascii PLY: 40 x 20 points of a wavy sheet (x 0..3.9, y 0..1.9) with normals, intensity and comments.
inline std::string sheet_ply() {
  std::string text =
      "ply\nformat ascii 1.0\ncomment kept as it is\nelement vertex 800\nproperty float x\nproperty float y\nproperty "
      "float z\nproperty float nx\nproperty float ny\nproperty float nz\nproperty uchar intensity\nend_header\n";
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 40; ++x)
      text += std::to_string(0.1 * x) + " " + std::to_string(0.1 * y) + " " + std::to_string(0.05 * ((x + y) % 3)) +
              " 0 0 1 " + std::to_string((x * y) % 256) + "\n";
  return text;
}

/// Holds the left end of the sheet and turns the right one.
inline std::string turn_edit() {
  return R"({ "sinew": 1, "layers": [ { "method": "graph", "settings": { "nodes": 60 },
  "fixed": [ { "box": [[-1, -1, -1], [0.45, 3, 1]] } ],
  "handles": [ { "points": { "box": [[3.45, -1, -1], [5, 3, 1]] },
                 "rotate": { "axis": [0, 1, 0], "degrees": -50, "about": [2, 0, 0] } } ] } ] }
)";
}

}  // namespace sinew
