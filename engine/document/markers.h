#pragma once
/// Markers: a captured motion as a handle of places that move from frame to frame [Stoll et al. 2007, section 3.2].

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/document/project.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/deformer.h"
#include "engine/io/motion.h"

namespace sinew::document {

/// The frames of a motion: those that a still has, which it drives.
struct MotionTime {
  std::vector<int> frames;  ///< ascending
  double rate = 0;          ///< frames a second; 0: unknown
};
MotionTime time_of(const io::Trajectories& motion);

class Markers {
 public:
  /// Reads the file, bridges gaps, aligns with `body`: the shape that is driven, as it is in the first frame. Throws
  /// InputError: the file, a name that it has not, a frame that it has not, no marker seen in the first frame, matches
  /// on a line; where nothing says how they lie, fewer than 24 markers, or markers that lie nowhere on the body.
  Markers(const MarkersEdit& edit, const Shape& body);

  const MarkersEdit& edit() const { return edit_; }
  MotionTime time() const { return time_of(motion_); }

  /// Places in the frame that was aligned, and where they are at `frame`, of the markers seen in both; relative to
  /// `origin`. At a frame that the motion has not, none.
  Handle handle(int frame, const Vec3& origin) const;

  /// Markers and bones as they are to be seen at a frame, relative to `origin`.
  struct Picture {
    std::vector<Vec3> seen;  ///< of the markers that pull
    /// Of those that were not seen: where the gap is bridged, or of a released one where it was seen last (before it
    /// was ever seen: where it will be first).
    std::vector<Vec3> unseen;
    std::vector<std::pair<Vec3, Vec3>> bones;  ///< of a skeleton: all of it
    void add_to(Bounds& bounds) const;
  };
  Picture picture(int frame, const Vec3& origin) const;

  double scale() const { return scale_; }
  /// Distance of the matches, or of all markers from the body where they were laid on it, in the shape's unit; else 0.
  double fit_rms() const { return fit_rms_; }
  /// What was bridged, released or left out, one sentence each.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  void align(const Shape& body);
  void align_by_matches();
  void lay_on(const Shape& body);
  std::size_t row(int frame) const;
  Vec3 nearest_seen(std::size_t row, std::size_t point) const;
  Vec3 aligned(const Vec3& p) const { return scale_ * (R_ * p) + t_; }

  MarkersEdit edit_;
  io::Trajectories motion_;
  std::vector<std::vector<bool>> gap_;  ///< [frame][point]: it was not seen, bridged or not
  std::vector<std::size_t> used_;       ///< points of the motion
  std::vector<Vec3> places_;            ///< of each used one, in the file's coordinates
  std::size_t first_ = 0;               ///< row of the frame that is aligned
  double scale_ = 1, fit_rms_ = 0;
  Mat3 R_ = Mat3::Identity();
  Vec3 t_ = Vec3::Zero();
  std::vector<std::string> notes_;
};

/// The motion of a file over a shape that it has no matches with: with the longest extents of both along each other, as
/// large as the shape and in its middle, in the first frame. A place to begin to align them from. `shape`: in the
/// file's coordinates. Throws InputError: the file, or no marker seen in its first frame.
MarkersEdit markers_over(const std::string& path, const Bounds& shape);

/// The still with a frame for each of the motion.
Sequence over_time(const Sequence& still, const MotionTime& time);

/// The markers whose motion gives a still its frames: of the first layer that is on and has some; null where none has.
const MarkersEdit* driving_markers(std::span<const Layer> layers);

/// Whether nothing says how the markers lie, so that they are laid on the body.
bool laid_on_body(const MarkersEdit& edit);

/// The input with a frame for each of the motion that drives a layer; as it is where no layer that is on has markers,
/// or it has frames of its own.
Sequence with_frames_of_markers(const Sequence& input, std::span<const Layer> layers);

}  // namespace sinew::document
