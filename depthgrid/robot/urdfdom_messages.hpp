// What urdfdom says while it reads: kept instead of printed. Internal.
#pragma once

#include <memory>
#include <string>

namespace depthgrid::robot {

/// While one lives, messages of urdfdom go to it and not to the terminal. The output of its logger is one for the
/// process, so only one of these lives at a time: another thread's constructor waits.
class UrdfdomMessages {
 public:
  UrdfdomMessages();
  ~UrdfdomMessages();
  UrdfdomMessages(const UrdfdomMessages&) = delete;
  UrdfdomMessages& operator=(const UrdfdomMessages&) = delete;

  /// Errors so far, in one line; empty when there was none.
  [[nodiscard]] std::string errors() const;

 private:
  struct Handler;
  std::unique_ptr<Handler> handler_;
};

}  // namespace depthgrid::robot
