// depthgrid-lab latency: from a camera's exposure to the datagram, stage by stage, of a cell whose devices are there.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "depthgrid/cell/cell_file.hpp"
#include "depthgrid/core/error.hpp"
#include "depthgrid/monitor/open_cell.hpp"
#include "depthgrid/network/datagram.h"
#include "depthgrid/sensors/clock.hpp"
#include "lab/commands.hpp"
#include "lab/measure/clocks.hpp"
#include "lab/measure/json_file.hpp"
#include "lab/measure/samples.hpp"
#include "report/machine.hpp"
#include "report/number_text.hpp"

namespace depthgrid::lab {
namespace {

using monitor::TimeHistogram;

struct LatencyOptions {
  std::string cell;
  double seconds = 20;
  double settle_s = 4;
  std::string json;
  std::string name;
};

/// A controller's end of the datagrams: how old answer and exposure are when they arrive.
class Controller {
 public:
  Controller() : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof here;
    // NOLINTBEGIN(cppcoreguidelines-pro-type-reinterpret-cast): the interface of sockets
    if (socket_ < 0 || ::bind(socket_, reinterpret_cast<const sockaddr*>(&here), sizeof here) != 0 ||
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&here), &size) != 0) {
      fail("a socket cannot be opened");
    }
    // NOLINTEND(cppcoreguidelines-pro-type-reinterpret-cast)
    port_ = ntohs(here.sin_port);
  }
  ~Controller() {
    thread_ = {};
    (void)::close(socket_);
  }
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  void start() {
    thread_ = std::jthread([this](const std::stop_token& stop) { listen(stop); });
  }
  void stop() {
    thread_.request_stop();
    thread_.join();
  }
  [[nodiscard]] int port() const { return port_; }

  // After stop().
  Samples exposure_to_datagram_ms;
  Samples answer_to_datagram_ms;

 private:
  void listen(const std::stop_token& stop) {
    constexpr int kWait_ms = 50;
    std::array<unsigned char, 2048> bytes{};
    double exposure_s = 0;
    // What waits in the socket is of the time before.
    while (::recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT) >= 0) {
    }
    while (!stop.stop_requested()) {
      pollfd wait{.fd = socket_, .events = POLLIN, .revents = 0};
      if (::poll(&wait, 1, kWait_ms) != 1) {
        continue;
      }
      const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
      const double now_s = sensors::clock_now_s();
      depthgrid_answer answer{};
      if (size < 0 ||
          depthgrid_read_datagram(bytes.data(), static_cast<std::size_t>(size), &answer) != DEPTHGRID_DATAGRAM_OK) {
        continue;
      }
      answer_to_datagram_ms.add(1e3 * std::max(0.0, now_s - answer.exposure_s - answer.latency_s));
      if (answer.exposure_s > exposure_s) {  // the first answer on it
        exposure_s = answer.exposure_s;
        exposure_to_datagram_ms.add(1e3 * (now_s - exposure_s));
      }
    }
  }

  int socket_;
  int port_ = 0;
  std::jthread thread_;
};

Json stage(const std::string& name, const TimeHistogram& times) {
  constexpr double kMs = 1e3;
  const auto ms = [&](double share) {
    const std::optional<double> value = times.quantile_s(share);
    return value ? Json(kMs * *value) : Json(nullptr);
  };
  return {{"stage", name}, {"count", times.count()}, {"median_ms", ms(0.5)}, {"ms_99_9", ms(0.999)}};
}

Json stage(const std::string& name, const Samples& ms) {
  return {{"stage", name},
          {"count", ms.count()},
          {"median_ms", finite(ms.median())},
          {"ms_99_9", finite(ms.quantile(0.999))}};
}

/// A cell that runs, with its datagrams to `controller`.
std::unique_ptr<monitor::Monitor> running(const cell::Cell& cell, const cell::CellSetup& setup,
                                          const Controller& controller) {
  auto made = std::make_unique<monitor::Monitor>(setup, monitor::monitor_settings(cell),
                                                 monitor::make_sources(cell, setup, monitor::ros2_node(cell)));
  cell::UdpEntry to;
  to.host = "127.0.0.1";
  to.port = controller.port();
  made->add(monitor::udp_output(to));
  made->start();
  return made;
}

void measure_latency(const LatencyOptions& options) {
  const cell::Cell cell = cell::load_cell(options.cell);
  const cell::CellSetup setup = cell::setup(cell);
  Controller controller;
  const auto monitor = running(cell, setup, controller);
  // Until the devices are found; the stages' figures have these seconds in them, the datagrams' and the load have not.
  (void)sensors::wait_until(sensors::clock_now_s() + options.settle_s, options.settle_s);
  const double begin_s = sensors::clock_now_s();
  const double used_s = process_time_s();
  controller.start();
  (void)sensors::wait_until(begin_s + options.seconds, options.seconds);
  const double seconds = sensors::clock_now_s() - begin_s;
  const double cores = (process_time_s() - used_s) / seconds;
  controller.stop();
  monitor->stop();
  const monitor::MonitorReport report = monitor->report();

  Json json;
  json["name"] = options.name;
  json["machine"] = report::machine_line("both");
  json["cameras"] = cell.cameras.size();
  json["seconds"] = seconds;
  json["asked_hz"] = static_cast<double>(report.answers) / report.seconds;
  json["cores"] = cores;
  json["images_hz"] = Json::array();
  json["stages"] = Json::array();
  // The camera whose images take longest.
  std::size_t slowest = 0;
  for (std::size_t k = 0; k < cell.cameras.size(); ++k) {
    json["images_hz"].push_back(static_cast<double>(report.cameras[k].taken) / report.seconds);
    if (monitor->receipt(k).quantile_s(0.5) > monitor->receipt(slowest).quantile_s(0.5)) {
      slowest = k;
    }
  }
  json["stages"].push_back(stage("receipt", monitor->receipt(slowest)));
  json["stages"].push_back(stage("preparation", monitor->preparation(slowest)));
  json["stages"].push_back(stage("hand-over", monitor->hand_over()));
  json["stages"].push_back(stage("asking", monitor->asking()));
  json["stages"].push_back(stage("sending", controller.answer_to_datagram_ms));
  json["stages"].push_back(stage("exposure to datagram", controller.exposure_to_datagram_ms));
  std::printf("%zu cameras, asked %s times a second, %s of a core\n| stage | median ms | 99.9 %% ms |\n|---|---|---|\n",
              cell.cameras.size(), report::fixed(json["asked_hz"].get<double>(), 0).c_str(),
              report::percent(cores).c_str());
  for (const Json& row : json["stages"]) {
    const auto text = [&](const char* key) {
      return row[key].is_number() ? report::fixed(row[key].get<double>(), 2) : std::string("-");
    };
    std::printf("| %s | %s | %s |\n", row["stage"].get<std::string>().c_str(), text("median_ms").c_str(),
                text("ms_99_9").c_str());
  }
  if (!options.json.empty()) {
    Json all;
    all["runs"] = Json::array();
    if (std::filesystem::exists(options.json)) {
      all = read_json_file(options.json, "list of runs", {"runs"});
      std::erase_if(all["runs"].get_ref<Json::array_t&>(),
                    [&](const Json& run) { return run.value("name", "") == options.name; });
    }
    all["runs"].push_back(json);
    write_json_file(options.json, all);
  }
  if (controller.exposure_to_datagram_ms.empty()) {
    fail(options.cell, ": no image came; do its devices send? (depthgrid-lab devices)");
  }
}

}  // namespace

void add_latency_command(CLI::App& app) {
  const auto options = std::make_shared<LatencyOptions>();
  CLI::App* const command = app.add_subcommand(
      "latency", "from the exposure to the datagram, stage by stage, and the load, of a cell whose devices are there");
  command->add_option("CELL", options->cell)->required();
  command->add_option("--seconds", options->seconds)->check(CLI::Range(1.0, 1e5))->capture_default_str();
  command->add_option("--settle", options->settle_s, "seconds before")
      ->check(CLI::Range(0.0, 600.0))
      ->capture_default_str();
  command->add_option("--json", options->json, "adds the figures to this file, in place of those of the same name");
  command->add_option("--name", options->name, "of the figures");
  command->callback([options] { measure_latency(*options); });
}

}  // namespace depthgrid::lab
