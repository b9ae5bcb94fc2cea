// libFuzzer target: any bytes as each of the messages; the first byte says which. Either they are refused with an Error
// of one line that prints, or what was read comes back when it is written; and what is made of images and calibrations
// is such as the library's other parts take.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "depthgrid/core/error.hpp"
#include "depthgrid/core/printable_text.hpp"
#include "depthgrid/messages/serialization.hpp"

namespace {

using namespace depthgrid::messages;

void require(bool condition) {
  if (!condition) {
    std::abort();
  }
}

template <class Message>
void use(const Message& /*message*/) {}

template <>
void use(const Image& image) {
  DepthPixels pixels;
  const depthgrid::DepthView view = depth_view(image, pixels);
  static_cast<void>(depthgrid::measured_depth_m(view, {}, view.width_px - 1, view.height_px - 1));
  static_cast<void>(depthgrid::measured_depth_m(view, {}, 0, 0));
}

template <>
void use(const CompressedImage& image) {
  require(compressed_depth(image).png.size() + 12 == image.data.size());
}

template <>
void use(const CameraInfo& info) {
  for (const bool rectified : {false, true}) {
    depthgrid::validate(camera_model(info, rectified).intrinsics);
  }
}

template <class Message>
void check(std::span<const std::byte> bytes) {
  const Message message = from_bytes<Message>(bytes);
  const std::vector<std::byte> written = to_bytes(message);
  require(to_bytes(from_bytes<Message>(written)) == written);
  use(message);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const auto bytes = std::as_bytes(std::span(data + 1, size - 1));
  constexpr void (*kChecks[])(std::span<const std::byte>) = {
      check<Image>, check<CompressedImage>, check<CameraInfo>,  check<JointState>, check<Transforms>,
      check<Text>,  check<Markers>,         check<Diagnostics>, check<Distances>};
  try {
    kChecks[data[0] % std::size(kChecks)](bytes);
  } catch (const depthgrid::Error& error) {
    require(depthgrid::is_printable(error.what()));
  }
  return 0;
}
