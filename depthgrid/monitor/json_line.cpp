#include "depthgrid/monitor/json_line.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

namespace depthgrid::monitor {
namespace {

class JsonText {
 public:
  void key(std::string_view name) {
    separate();
    quote(name);
    text_ += ':';
    first_ = true;
  }
  void open(char bracket) {
    separate();
    text_ += bracket;
    first_ = true;
  }
  void close(char bracket) {
    text_ += bracket;
    first_ = false;
  }
  void text(std::string_view words) {
    separate();
    quote(words);
  }
  void number(double value) {
    separate();
    std::array<char, 64> digits{};
    const auto [end, error] =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, 6);
    text_ += std::isfinite(value) && error == std::errc{} ? std::string(digits.data(), end) : "null";
  }
  /// Down to a micrometre, so that a lower bound stays one.
  void bound(double value_m) { number(std::floor(value_m * 1e6) / 1e6); }
  void count(std::uint64_t value) {
    separate();
    text_ += std::to_string(value);
  }
  void yes(bool value) {
    separate();
    text_ += value ? "true" : "false";
  }
  [[nodiscard]] const std::string& result() const noexcept { return text_; }

 private:
  void separate() {
    if (!first_) {
      text_ += ',';
    }
    first_ = false;
  }
  /// Names are printable; quotes and backslashes are escaped.
  void quote(std::string_view words) {
    text_ += '"';
    for (const char c : words) {
      if (c == '"' || c == '\\') {
        text_ += '\\';
      }
      text_ += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
    text_ += '"';
  }

  std::string text_;
  bool first_ = true;
};

void add_parts(JsonText& json, const CellAnswer& answer, const Names& names) {
  json.key("parts");
  json.open('[');
  for (std::size_t i = 0; i < answer.parts.size(); ++i) {
    const Answer& part = answer.parts[i];
    json.open('{');
    json.key("part");
    json.text(names.parts.at(i));
    json.key("distance_m");
    json.bound(part.distance_now_m);
    json.key("state");
    json.text(to_string(part.nearest.state));
    json.key("nearest_m");
    json.open('[');
    for (int axis = 0; axis < 3; ++axis) {
      json.number(part.nearest.nearest_world[axis]);
    }
    json.close(']');
    json.close('}');
  }
  json.close(']');
}

void add_cameras(JsonText& json, const CellAnswer& answer, const Names& names) {
  json.key("cameras");
  json.open('[');
  for (std::size_t k = 0; k < answer.camera_count; ++k) {
    const CameraBasis& camera = answer.cameras.at(k);
    json.open('{');
    json.key("camera");
    json.text(names.cameras.at(k));
    json.key("state");
    json.text(to_string(camera.state));
    json.key("age_s");
    json.number(camera.age_s);
    json.key("without_reading");
    json.number(camera.without_reading);
    json.key("late");
    json.yes(camera.late);
    json.close('}');
  }
  json.close(']');
}

}  // namespace

std::string json_line(const CellAnswer& answer, const Names& names) {
  JsonText json;
  json.open('{');
  json.key("sequence");
  json.count(answer.sequence);
  json.key("time_s");
  json.number(answer.time_s);
  json.key("exposure_s");
  json.number(answer.exposure_s);
  json.key("latency_s");
  json.number(answer.done_s - answer.exposure_s);
  json.key("stop");
  json.yes(answer.stop);
  json.key("state");
  json.text(avoidance::to_string(answer.reason.limit));
  json.key("distance_m");
  json.bound(answer.distance_m);
  json.key("clear_m");
  json.bound(answer.clear_m);
  json.key("blind_m");
  json.number(answer.blind_m);
  json.key("skew_s");
  json.number(answer.skew_s);
  json.key("joints_age_s");
  json.number(answer.joints_age_s);
  json.key("reason");
  std::array<char, 640> buffer{};
  json.text(sentence(answer.reason, names, buffer));
  add_cameras(json, answer, names);
  add_parts(json, answer, names);
  json.close('}');
  return json.result();
}

}  // namespace depthgrid::monitor
