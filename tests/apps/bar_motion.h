#pragma once
/// A bar and a motion of six markers that bends it, as files: what tests of the window and of the command line share.

#include <cmath>
#include <fstream>
#include <string>

#include "apps/samples/meshes.h"
#include "engine/io/io.h"

namespace sinew::test {

/// 0.2 x 1 x 0.2 along y.
inline Shape small_bar() {
  return samples::box({4, 20, 4}, Vec3(0.05, 0.05, 0.05));
}

/// Frames 3 to 10 of markers in millimetres, z up: A to D at the foot's corners, E above the top and F in its middle,
/// which both lean to +x by 0.02 a frame. E is not seen in frames 6 and 7, F in frames 8 to 10.
inline std::string bar_motion() {
  std::string out = "frame,A.x,A.y,A.z,B.x,B.y,B.z,C.x,C.y,C.z,D.x,D.y,D.z,E.x,E.y,E.z,F.x,F.y,F.z\n";
  for (int frame = 3; frame <= 10; ++frame) {
    const double lean = 0.02 * (frame - 3);
    const Vec3 places[] = {{-0.1, 0, -0.1}, {0.1, 0, -0.1},     {0.1, 0, 0.1},
                           {-0.1, 0, 0.1},  {lean, 1.05, 0.05}, {lean, 0.95, 0}};
    out += std::to_string(frame);
    for (int m = 0; m < 6; ++m) {
      const bool unseen = (m == 4 && (frame == 6 || frame == 7)) || (m == 5 && frame >= 8);
      const Vec3 p = 1000 * Vec3(places[m].x(), -places[m].z(), places[m].y());
      for (const double x : {p.x(), p.y(), p.z()}) out += "," + (unseen ? "" : std::to_string(x));
    }
    out += "\n";
  }
  return out;
}

/// An edit of the bar and the motion that lie beside it as bar.obj and lean.csv: fitted by three matches.
inline std::string bar_edit() {
  return R"({ "sinew": 1, "inputs": ["bar.obj"], "layers": [ { "method": "tet", "markers": { "file": "lean.csv", "matches": [
  { "name": "A", "place": [-0.1, 0, -0.1] }, { "name": "B", "place": [0.1, 0, -0.1] },
  { "name": "C", "place": [0.1, 0, 0.1] } ] } } ] })";
}

/// Writes all three into a folder that ends in a slash, or is empty.
inline void write_bar_motion(const std::string& folder) {
  io::write(folder + "bar.obj", small_bar(), true);
  std::ofstream(folder + "lean.csv") << bar_motion();
  std::ofstream(folder + "lean.json") << bar_edit();
}

}  // namespace sinew::test
