#include "engine/document/solver_thread.h"

#include <exception>
#include <new>

namespace sinew::document {

namespace {

/// Whether building the deformer of layer `index` is still worth its time for `next`.
bool same_build(const SolveRequest& now, const SolveRequest& next, std::size_t index) {
  if (now.input != next.input || index >= next.layers.size()) return false;
  return next.layers[index].on && same_structure(now.layers[index], next.layers[index]);
}

}  // namespace

SolverThread::SolverThread(std::span<const Method> methods, std::function<void()> notify)
    : methods_(methods), notify_(std::move(notify)), thread_([this] { run(); }) {}

SolverThread::~SolverThread() {
  requests_.close();
  thread_.join();
}

void SolverThread::ask(SolveRequest request) {
  CHECK(request.input != nullptr, request.ticket);
  requests_.put(std::move(request));
}

void SolverThread::cancel() {
  requests_.put({});
}

void SolverThread::run() {
  while (std::optional<SolveRequest> request = requests_.wait()) {
    if (request->input == nullptr) continue;
    busy_ = true;
    serve(*request);
    building_ = 1;
    busy_ = false;
    if (notify_) notify_();  // one that was stopped has no answer, and is over all the same
  }
}

void SolverThread::serve(const SolveRequest& request) {
  SolveAnswer answer;
  try {
    answer = solve(request);
    if (!answer.finished) return;  // a newer request waits, and has been shown what there is
  } catch (const std::bad_alloc&) {
    answer.error = "expected enough memory for this edit, found too little";
  } catch (const std::exception& error) {
    answer.error = error.what();
  }
  if (!answer.error.empty()) {
    workspace_.reset();  // it may have been left in the middle of an update
    answer = {request.ticket, request.input, nullptr, request.frame, {}, true, false, answer.error};
  }
  building_ = 1;
  publish(std::move(answer));
}

SolveAnswer SolverThread::solve(const SolveRequest& request) {
  if (workspace_ == nullptr || input_ != request.input) {
    input_ = request.input;
    workspace_ = std::make_unique<Workspace>(request.input, methods_);
  }
  const std::shared_ptr<const Shape> shape = workspace_->input(request.frame);
  UpdateOptions options;
  options.frame = request.frame;
  options.solve.quality = request.quality;
  options.progress = [&](const char* what, std::size_t layer, double fraction) {
    const bool solving = std::string_view(what) == "solving";
    building_ = solving ? 1 : fraction;
    const auto stops = [&](const SolveRequest& next) { return solving || !same_build(request, next, layer); };
    return !requests_.closed() && !requests_.holds(stops);
  };
  options.on_iteration = [&](const std::vector<LayerResult>& layers) {
    publish({request.ticket, request.input, shape, request.frame, layers, false, false, ""});
    return true;
  };
  const UpdateResult result = workspace_->update(request.layers, options);
  const bool final_quality = !result.stopped && request.quality == SolveOptions::Quality::Final;
  return {request.ticket, request.input, shape, request.frame, result.layers, !result.stopped, final_quality, ""};
}

void SolverThread::publish(SolveAnswer answer) {
  answers_.put(std::move(answer));
  if (notify_) notify_();
}

}  // namespace sinew::document
