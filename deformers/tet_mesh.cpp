#include "deformers/tet_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "deformers/tet_check.h"
#include "deformers/tet_decimate.h"
#include "deformers/tet_process.h"
#include "deformers/tet_surface.h"
#include "deformers/tet_surface_edges.h"
#include "engine/geometry/error.h"

namespace sinew {

namespace {

/// A power of two that brings the surface's size near 1, where TetGen's tolerances are meant to be used.
double unit_scale(const std::vector<Vec3>& points) {
  double largest = 0;
  for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::ldexp(1.0, -exponent);
}

InputError crossing_error(const Shape& shape, const TetSurface& surface, const std::vector<Index>& triangles) {
  const Triangle& first = surface.triangles[triangles[0]];
  const Vec3 place = (surface.vertices[first[0]] + surface.vertices[first[1]] + surface.vertices[first[2]]) / 3;
  return InputError("expected faces that do not cross, found crossings of " + faces_text(surface, triangles) +
                    ", the first around " + place_text(shape, place));
}

struct Work {
  const Shape& shape;
  const TetMeshOptions& options;
  TetLimits limits;
  std::function<bool(double)> progress;
  std::vector<std::string>& notes;
};

std::optional<TetAnswer> run(const Work& work, tets::Job job, const TetSurface& surface) {
  std::vector<Vec3> scaled = surface.vertices;
  const double scale = unit_scale(surface.vertices);
  for (Vec3& p : scaled) p *= scale;
  std::optional<TetAnswer> answer = run_tets(job, scaled, surface.triangles, work.limits, work.progress);
  if (answer)
    for (Vec3& p : answer->added) p /= scale;
  return answer;
}

/// One of three: a mesh, why there is none, or nothing where progress said false.
struct Filled {
  std::optional<TetMesh> mesh;
  std::string why;
};

Filled fill(const Work& work, tets::Job job, const TetSurface& surface) {
  const std::optional<TetAnswer> answer = run(work, job, surface);
  if (!answer) return {};
  if (answer->how != TetAnswer::How::Done) return {{}, answer->why};
  if (answer->tets.empty()) return {{}, "none"};
  Filled filled;
  TetMesh mesh = checked_tets(work.shape, surface, *answer, filled.why, work.notes);
  if (filled.why.empty()) filled.mesh = std::move(mesh);
  return filled;
}

/// Where adding vertices inside goes wrong (a tet comes out flat or turned now and then), none are added.
Filled fill(const Work& work, const TetSurface& surface) {
  if (!work.options.inside) return fill(work, tets::Job::Fill, surface);
  Filled filled = fill(work, tets::Job::FillInside, surface);
  if (filled.why.empty()) return filled;
  filled = fill(work, tets::Job::Fill, surface);
  if (filled.mesh) work.notes.push_back("no vertices added inside, because that went wrong");
  return filled;
}

/// Throws where faces cross, or else `otherwise`, which gets whether it is known that none do. Returns where progress
/// said false.
template <class Otherwise>
void explain(const Work& work, const TetSurface& surface, const Otherwise& otherwise) {
  const std::optional<TetAnswer> answer = run(work, tets::Job::Crossings, surface);
  if (!answer) return;
  if (!answer->crossing.empty()) throw crossing_error(work.shape, surface, answer->crossing);
  throw otherwise(answer->how == TetAnswer::How::Done);
}

/// Null where progress said false.
std::optional<TetMesh> filled_whole(const Work& work, const TetSurface& surface) {
  Filled filled = fill(work, surface);
  if (!filled.why.empty())
    explain(work, surface, [&](bool known) {
      return InputError("expected tets, found " + filled.why +
                        (known ? "; no faces cross, but some may all but touch" : ""));
    });
  return std::move(filled.mesh);
}

/// A decimated surface may cross itself; one with more vertices is tried then. Null where progress said false.
std::optional<TetMesh> filled_decimated(const Work& work, const TetSurface& surface) {
  const std::string all = std::to_string(surface.vertices.size());
  auto wanted = static_cast<std::size_t>(std::max(work.options.vertices, 4));
  bool cancelled = false;
  const auto go_on = [&] {
    cancelled = cancelled || (work.progress && !work.progress(0));
    return !cancelled && std::chrono::steady_clock::now() < work.limits.end;
  };
  std::string tried;
  for (int attempt = 0; attempt < 5 && wanted < surface.vertices.size(); ++attempt, wanted += wanted / 2) {
    const TetSurface coarse = decimated_surface(surface, wanted, go_on);
    if (cancelled) return std::nullopt;
    const std::string count = std::to_string(coarse.vertices.size());
    Filled filled = is_closed(coarse) ? fill(work, coarse) : Filled{{}, "edges of more than two faces"};
    if (filled.mesh)
      work.notes.push_back(all + " vertices decimated to " + count +
                           (tried.empty() ? "" : "; to " + tried + " the faces crossed"));
    if (filled.why.empty()) return std::move(filled.mesh);
    tried += (tried.empty() ? "" : ", ") + count;
  }
  if (wanted >= surface.vertices.size()) {
    work.notes.push_back("all " + all + " vertices kept; decimated to " + tried + " the faces crossed");
    return filled_whole(work, surface);
  }
  explain(work, surface, [&](bool) {
    return InputError("expected faces that do not cross when decimated, found that they do with " + tried + " of " +
                      all + " vertices; more vertices keep them apart");
  });
  return std::nullopt;
}

}  // namespace

double tet_volume(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3) {
  return (p1 - p0).cross(p2 - p0).dot(p3 - p0) / 6;
}

TetMesh::Boundary TetMesh::boundary() const {
  struct Side {
    Triangle key, face;
    Index tet;
  };
  std::vector<Side> sides;
  sides.reserve(4 * tets.size());
  for (Index t = 0; t < tets.size(); ++t) {
    const auto [a, b, c, d] = tets[t];
    for (const Triangle& face : {Triangle{a, c, b}, Triangle{a, b, d}, Triangle{a, d, c}, Triangle{b, c, d}}) {
      Triangle key = face;
      std::sort(key.begin(), key.end());
      sides.push_back({key, face, t});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::pair(a.key, a.tet) < std::pair(b.key, b.tet); });
  Boundary boundary;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    if ((k > 0 && sides[k - 1].key == sides[k].key) || (k + 1 < sides.size() && sides[k + 1].key == sides[k].key))
      continue;
    boundary.faces.push_back(sides[k].face);
    boundary.tets.push_back(sides[k].tet);
  }
  return boundary;
}

std::optional<TetMesh> tetrahedralized(const Shape& shape, const TetMeshOptions& options,
                                       std::vector<std::string>& notes, const std::function<bool(double)>& progress) {
  const auto end = std::chrono::steady_clock::now() +
                   std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                       std::chrono::duration<double>(options.max_seconds < 1e6 ? options.max_seconds : 1e6));
  const TetLimits limits{end, options.max_seconds, options.max_bytes};
  double shown = 0;  // what is tried again begins anew, but nobody wants to see that
  const auto onwards = [&](double done) { return progress(shown = std::max(shown, done)); };
  const Work work{shape, options, limits, progress ? std::function<bool(double)>(onwards) : nullptr, notes};
  const TetSurface surface = closed_surface(shape, options.close_holes, notes);
  const bool small = static_cast<std::ptrdiff_t>(surface.vertices.size()) <= options.vertices;
  return small ? filled_whole(work, surface) : filled_decimated(work, surface);
}

TetMesh tet_mesh_of(const Shape& shape, std::vector<std::string>& notes) {
  TetMesh mesh;
  std::size_t turned = 0, flat = 0;
  std::vector<Index> number(shape.size(), ~Index{0});
  for (std::size_t t = 0; t < shape.tets.size(); ++t) {
    Tet tet = shape.tets[t];
    for (const Index corner : tet)
      if (corner >= shape.size())
        throw InputError("expected tets over " + counted(shape.size(), "point", "points") + ", found point " +
                         std::to_string(corner) + " in tet " + std::to_string(t));
    const double volume =
        tet_volume(shape.positions[tet[0]], shape.positions[tet[1]], shape.positions[tet[2]], shape.positions[tet[3]]);
    if (!(std::abs(volume) > 0) || !std::isfinite(volume)) {
      ++flat;
      continue;
    }
    if (volume < 0) {
      std::swap(tet[2], tet[3]);
      ++turned;
    }
    for (const Index corner : tet) number[corner] = 0;
    mesh.tets.push_back(tet);
  }
  if (mesh.tets.empty())
    throw InputError("expected tets of a volume, found " +
                     (shape.tets.empty() ? "none" : "that all " + std::to_string(flat) + " have none"));
  for (Index i = 0; i < number.size(); ++i) {
    if (number[i] != 0) continue;
    number[i] = static_cast<Index>(mesh.points.size());
    mesh.points.push_back(i);
    mesh.vertices.push_back(shape.positions[i]);
  }
  for (Tet& tet : mesh.tets)
    for (Index& v : tet) v = number[v];
  if (turned > 0) notes.push_back(counted(turned, "tet", "tets") + " turned, whose volume was negative");
  if (flat > 0) notes.push_back(counted(flat, "tet", "tets") + " without volume left out");
  return mesh;
}

}  // namespace sinew
