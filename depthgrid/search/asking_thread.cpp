#include "depthgrid/search/asking_thread.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "depthgrid/core/carried_answer.hpp"
#include "depthgrid/core/error.hpp"

namespace depthgrid::search {
namespace {

AskingOptions checked(const AskingOptions& options) {
  constexpr double kLongest_s = 3600;
  if (options.capsules < 1) {
    fail("asking thread: room for ", options.capsules, " capsules, must be at least 1: the most of one call");
  }
  if (!(options.period_s > 0 && options.period_s <= kLongest_s)) {
    fail("asking thread: period ", options.period_s, " s, must be above 0 and at most ", kLongest_s);
  }
  if (!(options.max_age_s >= options.period_s && options.max_age_s <= kLongest_s)) {
    fail("asking thread: answers are used up to an age of ", options.max_age_s, " s, must be at least the period, ",
         options.period_s, " s, and at most ", kLongest_s);
  }
  return options;
}

}  // namespace

AskingThread::AskingThread(SearchEvaluator& evaluator, const AskingOptions& options)
    : evaluator_(evaluator),
      options_(checked(options)),
      questions_(Question(options.capsules)),
      replies_(Reply(options.capsules)),
      thread_([this](const std::stop_token& stop) { ask_until_stopped(stop); }) {}

AskingThread::~AskingThread() = default;

double AskingThread::image_time_s(std::size_t camera) const noexcept {
  return camera < camera_count() ? replies_.front().image_times_s[camera] : Proximity::kNaN;
}

FrameUpdate AskingThread::update(std::size_t camera, const Frame& frame) noexcept {
  return evaluator_.update(camera, frame);
}

FrameUpdate AskingThread::update(std::size_t camera, const Frame& frame, const Pose& T_world_camera) noexcept {
  return evaluator_.update(camera, frame, T_world_camera);
}

void AskingThread::evaluate(std::span<const Capsule> capsules, double now_s, std::span<Answer> answers) noexcept {
  Question& question = questions_.back();
  question.count = std::min({capsules.size(), answers.size(), question.capsules.size()});
  std::copy_n(capsules.begin(), question.count, question.capsules.begin());
  question.now_s = now_s;
  // Before the question goes out, so that the answer is never to a question of this call.
  (void)replies_.take();
  questions_.publish();

  const Reply& reply = replies_.front();
  const double elapsed_s = now_s - reply.question.now_s;
  const bool usable = elapsed_s >= 0 && elapsed_s <= options_.max_age_s;
  const std::size_t known = usable ? std::min({capsules.size(), answers.size(), reply.question.count}) : 0;
  for (std::size_t i = 0; i < known; ++i) {
    answers[i] = carried_over(reply.answers[i], reply.question.capsules[i], capsules[i], elapsed_s,
                              evaluator_.store().settings().v_max_m_s);
  }
  std::fill(answers.begin() + static_cast<std::ptrdiff_t>(known), answers.end(), Answer{});
}

void AskingThread::ask_until_stopped(const std::stop_token& stop) noexcept {
  using Clock = std::chrono::steady_clock;
  const auto period = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options_.period_s));
  auto next = Clock::now();
  while (!stop.stop_requested()) {
    if (questions_.take()) {
      Reply& reply = replies_.back();
      const Question& question = questions_.front();
      std::copy_n(question.capsules.begin(), question.count, reply.question.capsules.begin());
      reply.question.count = question.count;
      reply.question.now_s = question.now_s;
      evaluator_.evaluate({question.capsules.data(), question.count}, question.now_s,
                          {reply.answers.data(), question.count});
      for (std::size_t k = 0; k < camera_count(); ++k) {
        reply.image_times_s[k] = evaluator_.image_time_s(k);
      }
      reply.impossible = evaluator_.impossible();
      replies_.publish();
      answered_.fetch_add(1, std::memory_order_relaxed);
    }
    next = std::max(next + period, Clock::now());
    // Not longer than a tenth of a second at once, so that the destructor does not wait for a long period.
    while (!stop.stop_requested() && Clock::now() < next) {
      std::this_thread::sleep_until(std::min(next, Clock::now() + std::chrono::milliseconds(100)));
    }
  }
}

}  // namespace depthgrid::search
