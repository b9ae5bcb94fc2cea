// A library with the functions of librealsense2 that are used, and devices that do as a test says.
#pragma once

#include <string>
#include <vector>

namespace depthgrid::test {

/// What the devices are and do. Tests set it while no stream runs, but for the fields that say otherwise.
struct FakeRealSense {
  std::vector<std::string> serials{"941322070001"};
  std::string held;              ///< serial number of one that another program holds
  int domain = 2;                ///< of stamps: global time; also while it runs
  bool has_metadata = true;      ///< of the exposure
  long exposure_us = 8000;       // NOLINT(*runtime-int): as of 64 bits
  double stamp_late_s = 0.012;   ///< the frame's stamp after the middle of the exposure
  double arrival_late_s = 0.03;  ///< the frame's arrival after the middle of the exposure
  double stamp_off_s = 0;        ///< of every stamp
  int hardware_first = 0;        ///< so many frames have stamps of the device's own clock, whatever `domain` says
  double stall_s = 0;            ///< more that it is late, beyond the lag of the frames before; also while it runs
  int frame_width = 640;         ///< of the frames that come; also while it runs
  double metres_per_unit = 0.001;
  bool distorts = false;
  bool refuses_preset = false;
  int last_option = 1000;           ///< greater ones are an error, as in older libraries
  int ignored_option = -1;          ///< it stays as it is, without an error
  std::string start_error;          ///< not empty: rs2_start fails so
  bool frames_have_errors = false;  ///< rs2_get_frame_data fails
  bool is_silent = false;           ///< no frames; also while it runs
};

/// What the library keeps count of: objects that were handed out and not given back.
struct FakeCounts {
  int contexts = 0;
  int lists = 0;
  int devices = 0;
  int sensors = 0;
  int frames = 0;
  int errors = 0;
  int log_severity = -1;
  int settings = 0;  ///< how often an option was set
  int sent = 0;      ///< frames of devices that were handed over

  [[nodiscard]] int objects() const { return contexts + lists + devices + sensors + frames + errors; }
};

/// Pixel (x, y) of frame `number`, millimetres.
inline unsigned short fake_pixel(long number, int x, int y) {  // NOLINT(*runtime-int)
  return static_cast<unsigned short>(500 + (7 * number + x + 3 * y) % 2000);
}

}  // namespace depthgrid::test

// The library's own functions for tests; they are found by dlsym.
extern "C" {
void fake_realsense_set(const depthgrid::test::FakeRealSense* wanted);
void fake_realsense_count(depthgrid::test::FakeCounts* counts);
/// Takes all devices away, and tells those who listen.
void fake_realsense_unplug();
}
