#include <filesystem>

#include "apps/editor/session_opened.h"
#include "engine/document/edit.h"
#include "engine/document/evaluate.h"
#include "engine/document/settings.h"
#include "engine/io/control_points.h"
#include "engine/io/frame_pattern.h"
#include "engine/io/io.h"
#include "engine/io/motion.h"
#include "engine/io/sequence.h"

namespace sinew::editor {

namespace {

namespace fs = std::filesystem;

std::string absolute(const std::string& path) {
  return path.empty() ? path : fs::absolute(path).lexically_normal().string();
}

std::string name_of(const std::string& path) {
  return fs::path(path).filename().string();
}

bool is_edit(const std::string& path) {
  return fs::path(path).extension() == ".json";
}

/// Whether frames have other points than the first: another number of them, or other ids.
bool is_stream(const Sequence& sequence, const Shape& first) {
  if (sequence.frames.size() < 2) return false;
  const std::shared_ptr<const Shape> last = sequence.load(sequence.frames.back());
  const Attribute *a = first.find("id"), *b = last->find("id");
  return last->size() != first.size() || (a != nullptr && b != nullptr && a->values != b->values);
}

/// How many files there are with this name but for the last number in it; 0 where it has none.
std::size_t files_of_run(const std::string& path) {
  const std::string pattern = pattern_of_run(path);
  if (pattern.empty()) return 0;
  const std::optional<io::FramePattern> parsed = io::frame_pattern(pattern);
  return parsed ? io::frames_on_disk(*parsed).size() : 0;
}

}  // namespace

std::string pattern_of_run(const std::string& path) {
  const std::string name = name_of(path);
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos || dot == 0) return {};
  std::size_t begin = dot;
  while (begin > 0 && name[begin - 1] >= '0' && name[begin - 1] <= '9') --begin;
  const std::size_t width = dot - begin;
  if (width == 0 || width > 9) return {};
  const std::string pattern = name.substr(0, begin) + (width == 1 ? "@" : std::string(width, '#')) + name.substr(dot);
  return (fs::path(path).parent_path() / pattern).string();
}

void Session::open(const std::vector<std::string>& paths) {
  open_next({Opening::As::Either, paths});
}

void Session::open_shape(const std::string& path) {
  open_next({Opening::As::Shape, {path}});
}

void Session::add_poses(const std::string& path) {
  open_next({Opening::As::Poses, {path}});
}

void Session::open_next(Opening opening) {
  for (std::string& path : opening.paths) path = absolute(path);
  if (opening.paths.empty()) return;
  declined_.reset();
  next_open_ = std::move(opening);
  if (background_->busy() && background_->can_cancel()) background_->cancel();
  start_waiting();
}

/// All that takes long for a big shape: bounds, which points are finite, what the selections of the layers are.
void Session::prepare(Opened& opened) {
  if (opened.sequence == nullptr) opened.sequence = std::make_shared<const Sequence>(still(opened.shape));
  opened.stream = is_stream(*opened.sequence, *opened.shape);
  opened.bounds = bounds_of(opened.shape->positions);
  opened.finite = finite_points(opened.shape->positions);
  opened.selector = std::make_shared<document::Selector>(opened.shape);
  if (opened.sequence->frames.size() > 1) return;  // the solver makes selections at their frames
  for (const document::Layer& layer : opened.project.layers) points_of(layer, *opened.selector);
}

void Session::open_now(const Opening& opening) {
  const std::string& path = opening.paths.front();
  const bool several = opening.paths.size() > 1 || fs::is_directory(path);
  if (opening.as == Opening::As::Recovered) {
    read_journal(opening.journal);
  } else if (opening.as == Opening::As::Poses || opening.as == Opening::As::FirstPoses) {
    open_poses(opening);
  } else if (opening.as == Opening::As::Shape) {
    read(path);
  } else if (opening.as == Opening::As::ControlPoints || io::is_control_points(path)) {
    open_control_points(path);
  } else if (io::is_motion(path)) {
    open_motion(path);
  } else if (several && !has_input()) {
    open_first(opening.paths);
  } else if (!is_edit(path) && joins(opening.paths)) {
    open_poses(opening);
  } else {
    read(path);
  }
}

void Session::read(const std::string& path) {
  const auto work = [this, path, present = input_, present_sequence = source_,
                     present_path = input_path_](const Tell& tell) -> Background::Finish {
    auto opened = std::make_shared<Opened>();
    opened->input_path = path;
    if (is_edit(path)) {
      opened->edit_path = path;
      opened->project = document::read_edit(path);
      document::check_layers(opened->project.layers, methods_);
      opened->input_path = opened->project.inputs.empty() ? "" : absolute(opened->project.inputs.front());
    }
    if (!opened->input_path.empty()) {
      read_shape(*opened, tell);
    } else if (present != nullptr) {
      opened->shape = present;
      opened->sequence = present_sequence;
      opened->input_path = present_path;
      opened->on_disk = false;  // the file lacks the input's name
      read_motion(*opened);
    } else {
      throw InputError(path + ": this edit names no shape; open its shape first, then the edit");
    }
    opened->project.inputs = {opened->input_path};
    prepare(*opened);
    if (!tell(1)) throw io::Cancelled{};
    return [this, opened] { show(std::move(*opened)); };
  };
  background_->start("Reading " + name_of(path), true, work);
}

/// The sequence and the shape of Opened::input_path, and the motion that drives it.
void Session::read_shape(Opened& opened, const Tell& tell) {
  io::ReadOptions options;
  options.progress = tell;
  opened.sequence = std::make_shared<const Sequence>(io::open_sequence(opened.input_path, options));
  opened.shape = opened.sequence->load(opened.sequence->frames.front());
  if (opened.sequence->frames.size() == 1) opened.run = files_of_run(opened.input_path);
  read_motion(opened);
}

void Session::read_motion(Opened& opened) {
  const document::MarkersEdit* driving = document::driving_markers(opened.project.layers);
  if (driving == nullptr) return;
  const document::Markers markers(*driving, *opened.shape);
  opened.motions[driving->path] = markers.time();
  opened.notes = notes_of(markers);
}

void Session::adopt(std::shared_ptr<const Shape> shape, const std::string& path, document::Project project) {
  Opened opened;
  opened.shape = std::move(shape);
  opened.input_path = absolute(path);
  opened.project = std::move(project);
  opened.project.inputs = {opened.input_path};
  prepare(opened);
  show(std::move(opened));
}

void Session::show(Opened opened) {
  close();
  input_ = std::move(opened.shape);
  source_ = sequence_ = std::move(opened.sequence);
  for (auto& [path, time] : opened.motions) motions_[path] = std::move(time);
  stream_ = opened.stream;
  frame_ = wanted_frame_ = sequence_->frames.front();
  input_path_ = std::move(opened.input_path);
  edit_path_ = std::move(opened.edit_path);
  bounds_ = opened.bounds;
  finite_ = std::move(opened.finite);
  selection_ = hidden_ = PointSet(input_->size());
  selector_ = std::move(opened.selector);
  history_ = opened.journal ? history_of(opened.journal->content()) : document::History(opened.project);
  saved_ = opened.on_disk ? opened.project : document::Project{};
  begin_journal(opened);
  layer_ = opened.project.layers.empty() ? 0 : opened.project.layers.size() - 1;
  changed_.input = true;
  if (opened.run > 1)
    notices_.push_back({Severity::Info,
                        name_of(input_path_) + " is one of " + std::to_string(opened.run) +
                            " numbered files: they can be opened as the frames of one motion.",
                        "file.open_run"});
  for (const std::string& note : opened.notes) notify(Severity::Info, note);
  for (const std::string& note : input_->notes) notify(Severity::Info, name_of(input_path_) + ": " + note);
  project_changed();
  hash_input(opened.project.hashes.of);
  ask(SolveOptions::Quality::Final, project());
}

void Session::close() {
  finish_waiting();
  if (journal_ != nullptr) journal_->end();
  hashing_->cancel();
  input_hash_.clear();
  solver_->cancel();
  drag_.reset();
  settling_.reset();
  input_.reset();
  source_.reset();
  sequence_.reset();
  driven_by_.clear();
  stream_ = playing_ = false;
  range_.reset();
  selector_.reset();
  neighbourhood_.reset();
  after_neighbourhood_.clear();
  waiting_.clear();
  shown_.clear();
  failure_.clear();
  bent_.clear();
  bent_ready_ = false;
  ++bent_version_;
  input_path_.clear();
  edit_path_.clear();
  lost_.clear();
  bounds_ = {};
  finite_ = {};
  selection_ = hidden_ = {};
  history_ = document::History(document::Project{});
  saved_ = {};
  layer_ = 0;
  handle_.reset();
  figures_ = {};
  answered_ = true;
  changed_ = {true, true, true, true, true, true};
  project_changed();
}

void Session::save_edit(const std::string& path) {
  if (!has_input()) return;
  play(false);
  const std::string target = path.empty() ? edit_path_ : absolute(path);
  if (target.empty()) {
    notify(Severity::Warning, "This edit has no file yet: choose a name for it.");
    return;
  }
  waiting_.push_back({Waiting::What::Save, target, true});
  start_waiting();
}

void Session::export_shape(const std::string& path, bool force) {
  if (!has_input()) return;
  play(false);
  waiting_.push_back({Waiting::What::Export, absolute(path), force});
  start_waiting();
}

/// Before another shape takes the place of this one: what was to be saved is saved as it stands.
bool Session::finish_waiting() {
  bool saved = true;
  for (const Waiting& waiting : std::exchange(waiting_, {})) {
    if (waiting.what == Waiting::What::Export) {
      notify(Severity::Warning,
             name_of(waiting.path) + " was not written: another file was opened before it could be.");
      continue;
    }
    saved &= refuse([&] { save_project(waiting.path, project(), input_hash_); });
  }
  return saved;
}

/// Begins the next work that waits for its turn on the background thread.
void Session::start_waiting() {
  if (background_->busy()) return;
  if (next_open_) {
    open_now(*std::exchange(next_open_, std::nullopt));
  } else if (!waiting_.empty() && settled()) {
    const Waiting waiting = waiting_.front();
    waiting_.erase(waiting_.begin());
    if (waiting.what == Waiting::What::Save)
      save_now(waiting);
    else
      export_now(waiting);
  } else if (!after_neighbourhood_.empty() && neighbourhood_ == nullptr) {
    background_->start("Finding neighbours", true, [this, shape = input_](const Tell& tell) -> Background::Finish {
      const auto found = std::make_shared<const Neighbourhood>(neighbourhood_of(*shape));
      if (!tell(1)) throw io::Cancelled{};
      return [this, shape, found] {
        if (shape != input_) return;
        neighbourhood_ = found;
        for (const std::function<void()>& then : std::exchange(after_neighbourhood_, {})) then();
      };
    });
  }
}

void Session::save_now(const Waiting& waiting) {
  const auto work = [this, path = waiting.path, project = project(), input = input_, hash = input_hash_,
                     serial = history_.state(history_.position()).serial](const Tell&) -> Background::Finish {
    save_project(path, project, hash);
    return [this, path, project, input, serial] {
      if (input != input_) return;
      saved_ = project;
      edit_path_ = path;
      if (journal_ != nullptr) journal_->saved(history_, serial, path);
      project_changed();
      notify(Severity::Info, "Saved " + name_of(path) + ".");
    };
  };
  background_->start("Saving " + name_of(waiting.path), false, work);
}

void Session::export_now(const Waiting& waiting) {
  if (io::names_frames(waiting.path)) {
    export_frames(waiting);
    return;
  }
  // Evaluated anew rather than bent by the weights that are shown: attributes need their gradients.
  const auto work = [this, waiting, sequence = sequence_, frame = frame_,
                     layers = project().layers](const Tell& tell) -> Background::Finish {
    document::Workspace workspace(sequence, file_methods_);
    document::EvaluateOptions options;
    options.progress = [&](const char*, std::size_t, double) { return tell(-1); };
    const std::shared_ptr<const Shape> shape = document::evaluate(workspace, layers, frame, options).shape;
    const auto report = std::make_shared<io::WriteReport>(io::write(waiting.path, *shape, waiting.force));
    return [this, path = waiting.path, report] {
      lost_ = report->lost;
      for (const std::string& lost : report->lost) notify(Severity::Warning, name_of(path) + ": " + lost);
      notify(Severity::Info, "Exported " + name_of(path) + ".");
    };
  };
  background_->start("Exporting " + name_of(waiting.path), true, work);
}

/// All frames, each as `sinew deform` writes it.
void Session::export_frames(const Waiting& waiting) {
  const auto work = [this, waiting, sequence = sequence_,
                     layers = project().layers](const Tell& tell) -> Background::Finish {
    io::FrameWriterOptions options;
    options.frames = sequence->frames;
    options.rate = sequence->rate;
    options.force = waiting.force;
    const std::unique_ptr<io::FrameWriter> writer = io::create_frames(waiting.path, options);
    document::Workspace workspace(sequence, file_methods_);
    for (std::size_t i = 0; i < sequence->frames.size(); ++i) {
      const double done = static_cast<double>(i) / static_cast<double>(sequence->frames.size());
      document::EvaluateOptions evaluating;
      evaluating.progress = [&](const char*, std::size_t, double) { return tell(done); };
      if (!tell(done)) throw io::Cancelled{};
      const int frame = sequence->frames[i];
      writer->write(frame, *document::evaluate(workspace, layers, frame, evaluating).shape);
    }
    const auto report = std::make_shared<io::WriteReport>(writer->commit());
    return [this, path = waiting.path, report, count = sequence->frames.size()] {
      lost_ = report->lost;
      for (const std::string& lost : report->lost) notify(Severity::Warning, name_of(path) + ": " + lost);
      notify(Severity::Info, "Exported " + std::to_string(count) + " frames to " + name_of(path) + ".");
    };
  };
  background_->start("Exporting " + name_of(waiting.path), true, work);
}

std::optional<Job> Session::job() const {
  if (background_->busy())
    return Job{background_->what(), background_->fraction(), background_->seconds(), background_->can_cancel()};
  if (preparing())
    return Job{"Preparing the layer", solver_->building(), preparing_since_ ? seconds_now() - *preparing_since_ : 0,
               true};
  return std::nullopt;
}

bool Session::preparing() const {
  return has_input() && solver_->busy() && solver_->building() < 1;
}

/// The layer stays as it is in the project, without an answer, until something of it changes.
void Session::cancel_preparing() {
  cancel_drag();
  solver_->cancel();
  wanted_frame_ = frame_;
  playing_ = false;
  answered_ = true;
  settling_.reset();
  final_ticket_ = ++ticket_;  // an answer that is on its way is not wanted any more
  failure_ = "Preparing the layer was cancelled; any change to it begins anew.";
  changed_.project = true;
}

void Session::cancel_job() {
  if (background_->busy()) {
    if (background_->can_cancel()) background_->cancel();
  } else if (preparing()) {
    cancel_preparing();
  }
  after_neighbourhood_.clear();
  next_open_.reset();
}

void Session::take_background() {
  std::optional<Background::Outcome> outcome = background_->take();
  if (!outcome) return;
  if (!outcome->error.empty()) notify(Severity::Error, outcome->error);
  if (outcome->finish) outcome->finish();
  if (neighbourhood_ == nullptr && (outcome->cancelled || !outcome->error.empty())) after_neighbourhood_.clear();
}

}  // namespace sinew::editor
