#include "dds/loopback.hpp"

#include <cstdint>
#include <span>

namespace depthgrid::dds {

NodeSettings loopback(const std::string& name, int domain) {
  return {.name = name, .name_space = "/", .domain = domain, .configuration = R"(<CycloneDDS><Domain>
              <General><Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
                <AllowMulticast>false</AllowMulticast></General>
              <Discovery><ParticipantIndex>auto</ParticipantIndex><Peers><Peer address="127.0.0.1"/></Peers>
                <MaxAutoParticipantIndex>20</MaxAutoParticipantIndex></Discovery>
            </Domain></CycloneDDS>)"};
}

std::vector<std::byte> numbered_image(int number, int width_px, int height_px) {
  std::vector<std::uint16_t> pixels(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  for (std::size_t n = 0; n < pixels.size(); ++n) {
    pixels[n] = static_cast<std::uint16_t>(n * 7919 + static_cast<std::size_t>(number) * 104729);
  }
  messages::Image image;
  image.header.frame_id = "camera";
  image.header.stamp.sec = number;
  image.width = static_cast<std::uint32_t>(width_px);
  image.height = static_cast<std::uint32_t>(height_px);
  image.step = 2 * image.width;
  image.encoding = "16UC1";
  image.data = std::as_bytes(std::span(pixels));
  return messages::to_bytes(image);
}

}  // namespace depthgrid::dds
