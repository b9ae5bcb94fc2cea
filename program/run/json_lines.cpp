#include "program/run/json_lines.hpp"

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "depthgrid/core/error.hpp"
#include "depthgrid/monitor/json_line.hpp"
#include "program/warning.hpp"

namespace depthgrid::program {
namespace {

struct CloseUnlessStandard {
  void operator()(std::FILE* file) const noexcept {
    if (file != stdout) {
      (void)std::fclose(file);
    }
  }
};

class JsonLines final : public monitor::Output {
 public:
  JsonLines(const std::filesystem::path& file, monitor::Names names, std::shared_ptr<std::atomic<bool>> failed)
      : name_(file.string()),
        file_(file.filename() == "-" ? stdout : std::fopen(file.c_str(), "we")),
        names_(std::move(names)),
        failed_(std::move(failed)) {
    if (file_ == nullptr) {
      fail(name_, ": cannot be written: ", std::generic_category().message(errno));
    }
    // A line that does not reach the disk is missed when it is written, not at the end.
    (void)std::setvbuf(file_.get(), nullptr, _IOLBF, kBuffer);
  }
  void take(const monitor::CellAnswer& answer) override {
    const std::string line = monitor::json_line(answer, names_) + "\n";
    if (std::fputs(line.c_str(), file_.get()) >= 0) {
      return;
    }
    const int why = errno;
    std::clearerr(file_.get());
    if (!failed_->exchange(true)) {
      warn(name_ + ": a line was not written: " + std::generic_category().message(why));
    }
    fail("a line was not written");
  }

 private:
  static constexpr std::size_t kBuffer = 1 << 16;
  std::string name_;
  std::unique_ptr<std::FILE, CloseUnlessStandard> file_;
  monitor::Names names_;
  std::shared_ptr<std::atomic<bool>> failed_;
};

}  // namespace

std::unique_ptr<monitor::Output> json_lines(const std::filesystem::path& file, monitor::Names names,
                                            std::shared_ptr<std::atomic<bool>> failed) {
  return std::make_unique<JsonLines>(file, std::move(names), std::move(failed));
}

}  // namespace depthgrid::program
