#include "report/machine.hpp"

#include <array>
#include <ctime>
#include <fstream>
#include <thread>

namespace depthgrid::report {
namespace {

std::string processor() {
  std::ifstream cpuinfo("/proc/cpuinfo");
  std::string line;
  while (std::getline(cpuinfo, line)) {
    const auto colon = line.find(':');
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) {
      return line.substr(colon + 2);
    }
  }
  return "unknown processor";
}

std::string instruction_sets() {
#if defined(__x86_64__)
  __builtin_cpu_init();
  std::string sets = "x86-64";
  if (static_cast<int>(__builtin_cpu_supports("avx2")) != 0) {
    sets += ", AVX2";
  }
  if (static_cast<int>(__builtin_cpu_supports("avx512f")) != 0) {
    sets += ", AVX-512";
  }
  return sets;
#else
  return "not x86";
#endif
}

std::string built_for() {
#if defined(__AVX512F__)
  return "AVX-512";
#elif defined(__AVX2__)
  return "AVX2";
#else
  return "the baseline";
#endif
}

std::string compiler() {
#if defined(__clang__)
  return std::string("clang ") + __clang_version__;
#else
  return std::string("g++ ") + __VERSION__;
#endif
}

}  // namespace

std::string today() { return now_utc().substr(0, 10); }

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  std::tm date{};
  gmtime_r(&now, &date);
  std::array<char, 32> text{};
  (void)std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &date);
  return text.data();
}

std::string machine_line(std::string_view used) {
  return processor() + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores (" + instruction_sets() +
         "), " + std::string(used) + " used; built for " + built_for() + " by " + compiler() + "; " + today();
}

}  // namespace depthgrid::report
