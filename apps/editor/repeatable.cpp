#include "apps/editor/repeatable.h"

namespace sinew::editor {

namespace {

class Repeatable final : public Deformer {
 public:
  explicit Repeatable(std::unique_ptr<Deformer> inner) : inner_(std::move(inner)) {}

  const SkinWeights& weights() const override { return inner_->weights(); }
  SkinWeights bind(std::span<const Vec3> points, Gradients gradients) const override {
    return inner_->bind(points, gradients);
  }
  void follow(std::shared_ptr<const Shape> rest) override {
    inner_->follow(std::move(rest));
    followed_ = true;
    if (!start_.empty()) start_ = inner_->pose();  // the same x where the structure is now
  }
  std::vector<double> map_energy() const override { return inner_->map_energy(); }
  std::unique_ptr<Deformer> refined() const override {
    std::unique_ptr<Deformer> finer = inner_->refined();
    if (finer == nullptr) return nullptr;
    auto out = std::make_unique<Repeatable>(std::move(finer));
    out->start_ = out->inner_->pose();
    return out;
  }
  const Pose& pose() const override { return inner_->pose(); }
  Structure structure() const override { return inner_->structure(); }
  Figures counts() const override { return inner_->counts(); }
  std::vector<std::string> notes() const override { return inner_->notes(); }
  std::vector<Table> binding() const override { return inner_->binding(); }

  SolveReport solve(const Constraints& constraints, const SolveOptions& options) override {
    // What moves is put where it is to begin by the workspace: at a pose of another frame, from which it has come.
    if (options.quality == SolveOptions::Quality::Final && !followed_) {
      inner_->reset();
      if (!start_.empty()) inner_->start_from(start_);
    }
    return inner_->solve(constraints, options);
  }

  void reset() override {
    start_.clear();
    followed_ = false;
    inner_->reset();
  }
  void start_from(const Pose& pose) override {
    start_ = pose;
    followed_ = false;
    inner_->start_from(pose);
  }

 private:
  std::unique_ptr<Deformer> inner_;
  Pose start_;             ///< empty: rest
  bool followed_ = false;  ///< another rest shape was taken since it was put somewhere
};

}  // namespace

std::vector<Method> repeatable(std::span<const Method> methods) {
  std::vector<Method> out(methods.begin(), methods.end());
  for (Method& method : out)
    method.make = [make = method.make](std::shared_ptr<const Shape> rest, const Settings& settings,
                                       const StructureWishes& wishes,
                                       const std::function<bool(double)>& progress) -> std::unique_ptr<Deformer> {
      std::unique_ptr<Deformer> inner = make(std::move(rest), settings, wishes, progress);
      if (inner == nullptr) return nullptr;
      return std::make_unique<Repeatable>(std::move(inner));
    };
  return out;
}

}  // namespace sinew::editor
