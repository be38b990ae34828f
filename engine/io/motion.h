#pragma once
/// Motion capture: named points over frames, read from C3D, TRC, BVH and CSV by a table of their own. Files of shapes
/// are in io.h.

#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew::io {

/// Markers, or the joints and ends of a skeleton. Lengths and axes are the file's.
struct Trajectories {
  std::vector<std::string> names;         ///< of the points; as the file has them, so one may stand twice
  int first_frame = 1;                    ///< number of frames[0]
  double rate = 0;                        ///< frames a second; 0 where the file does not say
  std::string unit;                       ///< "mm", "m", ...; empty where the file does not say
  std::vector<std::vector<Vec3>> frames;  ///< frames[f][point]; all three NaN where the point was not seen
  std::vector<std::string> notes;         ///< sentences on what was odd in the file

  /// Of a skeleton only:
  std::vector<std::array<int, 2>> bones;  ///< pairs of points (parent, child)
  std::vector<Vec3> rest;                 ///< of each point where all channels are zero
  /// transforms[f][point] takes what hangs on the point from the rest to the frame: x' = A x + t with [A t], of
  /// coordinates of the file's space. An end turns with its joint.
  std::vector<std::vector<Eigen::Matrix<double, 3, 4>>> transforms;
};

inline bool seen(const Vec3& p) {
  return p.allFinite();
}
inline const Vec3 not_seen = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());

struct WriteReport;

struct MotionFormat {
  std::string name;       ///< "C3D"
  std::string extension;  ///< lower case, without the dot
  std::string help;       ///< what of the format is read, one line
  /// Parses the bytes of a file; `path` is only for messages. Throws InputError.
  Trajectories (*read)(const std::string& path, std::span<const std::byte> bytes);
  /// The bytes of a file that holds `motion`. Null where the format is only read.
  std::vector<std::byte> (*write)(const Trajectories& motion, WriteReport& report) = nullptr;
};

std::span<const MotionFormat> motion_formats();

/// By the extension, of "-" by `as`; null where it is none of motion. ".csv" is one of shapes as well.
const MotionFormat* motion_format_of(const std::string& path, const std::string& as = "");

/// Whether a file is meant as motion: by its extension; a .csv where its first row has columns of markers, of the frame
/// or time, and none else. False where it can't be read.
bool is_motion(const std::string& path);

/// There is at least one frame of at least one point, and each frame has as many points as there are names. Throws
/// InputError. "-" is standard input, in the format of the extension `as`.
Trajectories read_motion(const std::string& path, const std::string& as = "");

/// Frames in which a point was not seen, by their numbers.
struct Gap {
  int first = 0, last = 0;
  bool bridged = false;
};

struct GapReport {
  struct Marker {
    std::string name;
    std::vector<Gap> gaps;                  ///< ascending
    std::size_t bridged = 0, released = 0;  ///< frames
  };
  std::vector<Marker> markers;            ///< as many as there are names
  std::size_t bridged = 0, released = 0;  ///< frames of all markers

  /// One for each marker that has gaps: "L_ARM: 5 frames bridged (10-12, 20-21), 30 released (40-69)."
  std::vector<std::string> sentences() const;
};

/// The gaps as they are, all of them released.
GapReport gaps_of(const Trajectories& motion);

/// Fills gaps of up to `longest` frames between two frames a < b in which the point was seen, by the cubic Hermite
/// polynomial of their positions p and velocities v (per frame):
///   p(s) = (2s^3 - 3s^2 + 1) p_a + (s^3 - 2s^2 + s) h v_a + (3s^2 - 2s^3) p_b + (s^3 - s^2) h v_b,
///   h = b - a, s = (f - a) / h,
///   v_a = (3 p_a - 4 p_{a-1} + p_{a-2}) / 2 where both frames before a were seen, p_a - p_{a-1} where one was,
///         (p_b - p_a) / h where none was; v_b likewise of the frames after b.
/// So a motion that is quadratic in time comes back exactly. Velocities come from frames that were seen, never from
/// filled ones. Longer gaps and those at the beginning and the end stay: there the point is released. Transforms are
/// left as they are.
GapReport bridge_gaps(Trajectories& motion, int longest);

/// Frames a second of a step that a file has in few digits: 0.00833333 is 120. 0 where it is no step.
double rate_of_step(double seconds);

/// Throws InputError where a text of so many bytes cannot hold so many points: a long list of names and many rows that
/// are almost empty would take memory by their product.
void check_places(const std::string& path, std::size_t frames, std::size_t points, std::size_t bytes);

}  // namespace sinew::io
