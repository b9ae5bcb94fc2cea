#include "lab/experiments/loop/contact.hpp"

namespace depthgrid::experiments {

std::string_view to_string(ContactCause cause) noexcept {
  switch (cause) {
    case ContactCause::robot_stood:
      return "robot_stood";
    case ContactCause::faster_than_v_max:
      return "faster_than_v_max";
    case ContactCause::hidden:
      return "hidden";
    case ContactCause::robot_came:
      return "robot_came";
    case ContactCause::touched_from_the_start:
      return "touched_from_the_start";
  }
  return "unknown";
}

}  // namespace depthgrid::experiments
