#pragma once
/// Markers: a captured motion as a handle of places that move from frame to frame [Stoll et al. 2007, section 3.2].

#include <memory>
#include <string>
#include <vector>

#include "engine/document/project.h"
#include "engine/geometry/deformer.h"
#include "engine/io/motion.h"

namespace sinew::document {

class Markers {
 public:
  /// Reads the file, bridges gaps, aligns. Throws InputError: the file, a name that it has not, a frame that it has
  /// not, no marker seen in the first frame, matches on a line.
  explicit Markers(const MarkersEdit& edit);

  const MarkersEdit& edit() const { return edit_; }
  std::vector<int> frames() const;  ///< of the motion, ascending
  double rate() const { return motion_.rate; }

  /// Places in the frame that was aligned, and where they are at `frame`, of the markers seen in both; relative to
  /// `origin`. At a frame that the motion has not, none.
  Handle handle(int frame, const Vec3& origin) const;

  double scale() const { return scale_; }
  double fit_rms() const { return fit_rms_; }  ///< distance of the matches, in the shape's unit; 0 without
  /// What was bridged, released or left out, one sentence each.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  void align();
  std::size_t row(int frame) const;
  Vec3 aligned(const Vec3& p) const { return scale_ * (R_ * p) + t_; }

  MarkersEdit edit_;
  io::Trajectories motion_;
  std::vector<std::size_t> used_;  ///< points of the motion
  std::vector<Vec3> places_;       ///< of each used one, in the file's coordinates
  std::size_t first_ = 0;          ///< row of the frame that is aligned
  double scale_ = 1, fit_rms_ = 0;
  Mat3 R_ = Mat3::Identity();
  Vec3 t_ = Vec3::Zero();
  std::vector<std::string> notes_;
};

/// The input with a frame for each of the motion that drives a layer; as it is where no layer that is on has markers,
/// or it has frames of its own.
Sequence with_frames_of_markers(const Sequence& input, std::span<const Layer> layers);

}  // namespace sinew::document
