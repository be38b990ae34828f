#pragma once
/// Deformer: the interface of a method. It owns the unknowns x; from constraints it solves for x, and from x it gives a
/// Pose. Deformers know no file, window or GPU; the rest of the program knows them only by what stands here.

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/geometry/shape.h"
#include "engine/geometry/skin_weights.h"

namespace sinew {

/// Points that are to be at targets; both relative to the shape's origin, in its unit. There is a target for each of
/// `points`, then one for each of `places`.
struct Handle {
  std::vector<Index> points;
  std::vector<Vec3> targets;
  std::vector<Vec3> places = {};  ///< of the rest shape's space, inside or outside of it: markers, joints
  /// How far the handle is turned, where the user turned it: axis times radians, of any length, so that a twist by more
  /// than half a turn is known from a smaller one. The targets are where it ends.
  std::optional<Vec3> turn = {};

  bool operator==(const Handle&) const = default;
};

/// Points around which the material is so many times as stiff as elsewhere.
struct Stiff {
  std::vector<Index> points;
  double factor = 1;
  bool operator==(const Stiff&) const = default;
};

/// What an edit asks for. Indices are points of the shape that the deformer was made for.
struct Constraints {
  std::vector<Index> fixed = {};  ///< points that stay exactly where they are
  std::vector<Handle> handles = {};
  std::vector<std::vector<Index>> rigid = {};  ///< groups that turn as one, each of one piece or of many
  std::vector<Stiff> stiffness = {};
  /// For the first examples, how much of each there is to be (0 the rest shape, 1 the example); where there is no
  /// number, or none is given, the solver finds it.
  std::vector<std::optional<double>> example_weights = {};
};

enum class Status { Converged, MaxIterations, Stalled, Stopped, Failed };
const char* name_of(Status status);  ///< "converged", "max_iterations", "stalled", "stopped", "failed"

/// Named figures in the order they are shown; the names are those of the report (interface.md): "rotation", "nodes",
/// ...
using Figures = std::vector<std::pair<std::string, double>>;

struct SolveReport {
  Status status = Status::Converged;
  std::string message;  ///< one sentence where status is Stalled or Failed or something was left out; else empty
  int iterations = 0;
  Figures counts;         ///< unknowns, nodes, edges, ...
  Figures energy;         ///< total first, then its terms, weighted, in normalised coordinates
  double handle_rms = 0;  ///< distance of handle points from their targets, in units of the diagonal
  double handle_max = 0;
  std::vector<double> example_weights;  ///< as they are now, one for each example
  double prefactor_seconds = 0;         ///< ordering, symbolic analysis and constant parts, when handles came or went
  double solve_seconds = 0;             ///< all iterations
};

struct SolveOptions {
  /// Interactive: good enough to look at while dragging, from the last x, as fast as possible.
  /// Final: the minimum of the method's own energy to convergence.
  enum class Quality { Interactive, Final } quality = Quality::Final;
  int max_iterations = 100;
  double epsilon = 1e-6;  ///< of the method's stop tests
  /// Called after every accepted iteration with the Pose so far; false stops the solve (Status::Stopped).
  std::function<bool(const Pose&)> on_iteration;
};

class Deformer {
 public:
  virtual ~Deformer() = default;

  /// Weights of the shape's own points, bound when the deformer was made.
  virtual const SkinWeights& weights() const = 0;

  /// Weights of any other points of the same space, relative to the same origin, where the structure is now (follow).
  virtual SkinWeights bind(std::span<const Vec3> points, Gradients gradients) const = 0;

  /// Takes another frame of the same points as the rest shape: the structure goes where the points went that it was
  /// made on, weights() and x stay [Sumner et al. 2007, section 5, mesh animations]. rest->size() as before.
  virtual void follow(std::shared_ptr<const Shape> rest) = 0;

  /// Minimises from the present x (warm). What depends only on which points are fixed and which are handles is kept
  /// between calls and redone when they change. The pose is always usable afterwards, whatever the status.
  virtual SolveReport solve(const Constraints& constraints, const SolveOptions& options) = 0;

  /// The maps of the present x, in the shape's coordinates.
  virtual const Pose& pose() const = 0;

  /// x back to rest (the identity everywhere), or to an earlier pose of this deformer, to start from there. What
  /// earlier solves left behind that could steer the next one (factors of another x) is forgotten: the answer then
  /// depends on the pose, the constraints and the options alone, to the last bit.
  virtual void reset() = 0;
  virtual void start_from(const Pose& pose) = 0;

  /// The energy that belongs to each map at the present x (graph: a node's share of eq. 9), to show where the structure
  /// is strained; in normalised coordinates.
  virtual std::vector<double> map_energy() const = 0;

  /// A deformer of the same rest shape with a finer structure, made where map_energy says that this one is too coarse,
  /// its x this one's as nearly as it can be; null where this one is fine enough (or the method has no such thing).
  virtual std::unique_ptr<Deformer> refined() const = 0;

  /// Lines and dots to draw of the method's own structure (graph nodes and edges, tets, coarse shell), at rest:
  /// vertices relative to the shape's origin, edges as pairs of them, and the map each vertex follows.
  struct Structure {
    std::vector<Vec3> vertices;
    std::vector<std::pair<Index, Index>> edges;
    std::vector<Index> maps;
    std::vector<Tet> tets = {};      ///< of a solid, of its vertices; else none
    std::vector<Index> points = {};  ///< of a solid: the shape's point that each vertex is, or is nearest to
  };
  virtual Structure structure() const = 0;

  /// Sizes of that structure ("nodes", "edges", ...), and what was left out in making it, one sentence each.
  virtual Figures counts() const = 0;
  virtual std::vector<std::string> notes() const = 0;

  /// What a pose file needs in order to bind and bend other files without solving: plain numbers by name, each a table
  /// with `columns` numbers a row (graph: "nodes" 3, "neighbours" 1). Coordinates are relative to the shape's origin.
  struct Table {
    std::string name;
    int columns = 1;
    std::vector<double> values;
  };
  virtual std::vector<Table> binding() const = 0;
};

/// A setting of a method, described once: panel, edit file, `--set` and manual loop over it. Integers and choices are
/// kept as doubles; a choice is the index of its name.
struct Setting {
  std::string name;
  double standard = 0, min = 0, max = 0;
  std::string unit;  ///< "", "1/diagonal", "points", ...
  std::string help;  ///< one sentence
  bool integer = false;
  std::vector<std::string> choices;  ///< of a choice; otherwise empty
};

/// Values by name; what is missing has its standard value.
using Settings = std::vector<std::pair<std::string, double>>;
double value_of(const Settings& settings, std::span<const Setting> described, const std::string& name);

/// A curtain that parts what lies on its sides: the quads between each two neighbours of `path` and the same moved by
/// `depth`. No influence passes through it. Relative to the shape's origin, in its unit.
struct Cut {
  std::vector<Vec3> path;
  Vec3 depth = Vec3::Zero();
  bool operator==(const Cut&) const = default;
};

/// What the user chose of a method's structure, beside its settings.
struct StructureWishes {
  /// Points of the shape that it is built on (graph: the nodes); empty: the method chooses.
  std::span<const Index> points;
  /// Each of `points` is joined to the next and to no other: the path of a particle [Sumner et al. 2007, section 5].
  bool chain = false;
  std::span<const Cut> cuts;
  std::shared_ptr<const Shape> solid;  ///< tets to use instead of making some, relative to the shape's origin
  /// Poses of the same points and faces, each with its own origin.
  std::vector<std::shared_ptr<const Shape>> examples;
  /// What the examples are poses of, with the same points and faces: how it changes is applied to the shape. Null: the
  /// shape itself.
  std::shared_ptr<const Shape> examples_of;
};

/// A method as the application hands it to document: one row of the table in deformers/methods.h.
struct Method {
  std::string name;  ///< "graph", "tet", "shell"
  std::string help;  ///< one sentence
  std::vector<Setting> settings;
  /// Makes the deformer of a rest shape: builds its structure and binds the shape's points. Throws InputError where the
  /// shape can't be bent by this method. `progress` is called with 0..1; false cancels (returns null). May be empty.
  std::function<std::unique_ptr<Deformer>(std::shared_ptr<const Shape> rest, const Settings& settings,
                                          const StructureWishes& wishes, const std::function<bool(double)>& progress)>
      make;
  /// Binds points from the tables of a pose file (Deformer::binding) without a deformer. Throws InputError with a
  /// message about the tables (the caller adds the path).
  std::function<SkinWeights(const std::vector<Deformer::Table>& binding, std::span<const Vec3> points,
                            Gradients gradients)>
      bind;
  /// Which parts of an edit it knows, of those that not every method does.
  struct Parts {
    bool rigid = false, stiffness = false, places = false, solid = false, examples = false;
    bool nodes = false;  ///< StructureWishes::points, as a chain or not
    bool cuts = false;
  } parts = {};
};

}  // namespace sinew
