#include "depthgrid/core/reason_text.hpp"

#include "depthgrid/core/short_text.hpp"

namespace depthgrid {
namespace {

std::string_view without_reading(Unmeasured why) noexcept {
  switch (why) {
    case Unmeasured::blind_zone:
      return "space too near to a camera for it to measure";
    case Unmeasured::image_edge:
      return "space at the edge of a camera's image";
    case Unmeasured::late_image:
      return "space that only a camera without new images looks at";
    case Unmeasured::no_reading:
    case Unmeasured::not_told:
      break;
  }
  return "space without a reading";
}

std::string_view what_is(const Proximity& nearest) noexcept {
  switch (nearest.state) {
    case ProximityState::measured:
      return "a surface";
    case ProximityState::occluded:
      return "space hidden behind a surface";
    case ProximityState::unmeasured:
      return without_reading(nearest.unmeasured);
    case ProximityState::unobserved:
      return "space that no camera looks at";
    case ProximityState::outside:
      return "the border of the space of interest";
    case ProximityState::beyond_rho:
    case ProximityState::not_evaluated:
      break;
  }
  return "anything that may be there";
}

void add_origin(const Past& past, ShortText& text) noexcept {
  switch (past.origin) {
    case PastOrigin::not_told:
      return;
    case PastOrigin::never_ruled_out:
      text.add(", then something from space never seen free ");
      break;
    case PastOrigin::not_kept:
      text.add(", then something over the border of what is remembered ");
      break;
    case PastOrigin::earlier:
      text.add(", then something that may have been ");
      break;
  }
  text.add(past.from_m, " m from there");
}

void add_past(const Past& past, double now_s, ShortText& text) noexcept {
  switch (past.state) {
    case PastState::not_told:
      break;
    case PastState::never_ruled_out:
      text.add(", never seen free");
      break;
    case PastState::possible_again:
      text.add(", where nothing could be until ").add(now_s - past.possible_since_s, " s ago");
      add_origin(past, text);
      break;
    case PastState::not_kept:
      text.add(", outside of what is remembered");
      break;
    case PastState::ruled_out:
      text.add(", seen free by now");
      break;
  }
}

}  // namespace

std::string_view reason_text(const Proximity& nearest, const Past& past, double now_s,
                             std::span<char> buffer) noexcept {
  ShortText text(buffer);
  text.add(what_is(nearest));
  add_past(past, now_s, text);
  return text.text();
}

}  // namespace depthgrid
