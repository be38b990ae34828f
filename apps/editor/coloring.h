#pragma once
/// Coloring: the colour of each point from an attribute of the shape or from what the edit does there (a heat map), or
/// quiet tints that tell the parts of a scan set from each other.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/editor/background.h"
#include "engine/document/field.h"
#include "engine/geometry/shape.h"
#include "engine/gpu/colormap.h"

namespace sinew::editor {

class Session;
struct View;

/// Attributes that points can be coloured by: colours and single numbers, one a point.
std::vector<std::string> color_choices(const Shape& shape);

struct Coloring {
  std::vector<gpu::PointColor> colors;   ///< n, without marks
  std::optional<document::Field> field;  ///< the numbers that the colours stand for; nothing where they stand for none
  gpu::Colormap map = gpu::Colormap::Viridis;
  document::ValueRange range, usual, extent;  ///< of the ends of the map; the standard one; all there is
};

/// `attribute` empty or unknown: plain. Without a field: numbers have no colours yet (paint).
Coloring plain_coloring(const Shape& shape, const std::string& attribute);

/// The map that is used where the user chose none: that with a middle for what is signed.
gpu::Colormap usual_map(const document::Field& field);

/// The colours of `coloring.field` by a map (nothing: the usual one) and a range (nothing: the usual one).
void paint(Coloring& coloring, std::optional<gpu::Colormap> map, std::optional<document::ValueRange> range);

/// Keeps the colours of a session's points up to date. Heat maps are computed by a thread of its own, the newest pose
/// first, so that no picture of a drag waits for them.
class Painter {
 public:
  /// `wake` is called from that thread when poll() has something to take.
  explicit Painter(std::function<void()> wake = {}) : work_(std::move(wake)) {}

  /// Takes what the thread found; true where update() would change the colours.
  bool poll();
  /// True where the colours are others than after the last call. `session` has an input.
  bool update(Session& session, const View& view);
  const Coloring& coloring() const { return coloring_; }
  bool busy() const { return work_.busy(); }

 private:
  /// What a heat map was computed from.
  struct Source {
    std::shared_ptr<const Shape> input;
    document::FieldKind kind = document::FieldKind::Displacement;
    std::uint64_t version = 0;  ///< Session::bent_version
    std::size_t layer = 0;
    Index map = 0;
    bool operator==(const Source&) const = default;
  };
  struct Found {
    Source source;
    document::Field field;
    document::ValueRange extent;
  };

  bool update_heat(Session& session, const View& view);
  void begin(Session& session, const Source& wanted);

  Coloring coloring_;
  std::shared_ptr<const Shape> painted_;  ///< whose points coloring_ is of
  std::string attribute_;
  std::optional<gpu::Colormap> map_;
  std::optional<document::ValueRange> range_;
  bool hot_ = false;  ///< coloring_ is of a heat map
  std::optional<Source> begun_;
  std::optional<Found> found_;
  Background work_;
};

/// The map of the chosen layer whose influence is shown: the strongest of the chosen handle's points, else of the point
/// that was clicked last; nothing where neither is.
std::optional<Index> influencing_map(const Session& session, const View& view);

}  // namespace sinew::editor
