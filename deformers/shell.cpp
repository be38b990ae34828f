#include "deformers/shell.h"

#include "deformers/shell_pose.h"

namespace sinew {

namespace {

const std::vector<Setting>& shell_settings() {
  static const std::vector<Setting> settings = {
      {"vertices",
       1000,
       0,
       1000000,
       "",
       "About how many vertices larger shapes are solved with, the rest reconstructed; 0 solves with all of them.",
       true,
       {}},
      {"stretch", 100, 0.001, 1e6, "", "Resistance of the surface to stretching.", false, {}},
      {"bend", 1, 0, 1e6, "", "Resistance of the surface to bending.", false, {}},
      {"volume", 1000, 0, 1e9, "", "Resistance of a closed surface to a change of its volume.", false, {}},
      {"finish",
       0,
       0,
       1,
       "",
       "The final answer of a larger shape is reconstructed, or solved for with all vertices from there.",
       false,
       {"reconstructed", "solved"}},
      {"stiffness",
       0,
       0,
       1,
       "",
       "The same everywhere, or less where the examples stretch and bend more.",
       false,
       {"even", "learned"}},
  };
  return settings;
}

std::unique_ptr<Deformer> make(std::shared_ptr<const Shape> rest, const Settings& settings,
                               const StructureWishes& wishes, const std::function<bool(double)>& progress) {
  const auto value = [&](const char* name) { return value_of(settings, shell_settings(), name); };
  ShellOptions options;
  options.vertices = static_cast<std::size_t>(value("vertices"));
  options.finish = value("finish") == 1 ? ShellOptions::Finish::Solved : ShellOptions::Finish::Reconstructed;
  options.stiffness = {value("stretch"), value("bend"), value("volume"), value("stiffness") == 1};
  return make_shell_deformer(std::move(rest), wishes.examples, options, progress, wishes.examples_of.get());
}

SkinWeights bind_from_tables(const std::vector<Deformer::Table>& binding, std::span<const Vec3> points,
                             Gradients gradients) {
  return ShellSurface::from_tables(binding).bind(points, gradients);
}

}  // namespace

Method shell_method() {
  return {"shell",          "A thin shell: bends surfaces, and poses them by examples.",
          shell_settings(), make,
          bind_from_tables, {.stiffness = true, .examples = true}};
}

}  // namespace sinew
