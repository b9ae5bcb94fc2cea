// The line that stands for a random problem.
#include <array>
#include <sstream>
#include <type_traits>

#include "depthgrid/core/error.hpp"
#include "reference/random_problem.hpp"

namespace depthgrid::reference {
namespace {

constexpr std::array<const char*, 3> kShapes{"point", "sphere", "capsule"};

/// Calls visit(name, field) for every optional field, in the line's order.
template <class Options, class Visit>
void for_each_field(Options& options, Visit&& visit) {
  visit("cameras", options.cameras);
  visit("width", options.width_px);
  visit("rho", options.rho_m);
  visit("step", options.step_m);
  visit("margins", options.margins);
  visit("lateral", options.lateral);
  visit("invalid", options.invalid);
  visit("robot", options.robot);
  visit("units", options.units);
  visit("outside", options.outside);
  visit("thin", options.thin);
  visit("hand", options.hand);
  visit("box", options.box);
  visit("unobserved", options.unobserved);
  visit("pockets", options.pockets);
  visit("skew", options.skew);
  visit("moved", options.moved);
  visit("missing", options.missing);
  visit("smallest", options.smallest_m);
  visit("resolution", options.resolution_m);
  visit("within", options.within);
  visit("primitive", options.primitive);
  visit("query", options.query);
}

template <class Value>
Value parse_value(const std::string& word, const std::string& value) {
  if constexpr (std::is_same_v<Value, Shape>) {
    for (std::size_t i = 0; i < kShapes.size(); ++i) {
      if (value == kShapes[i]) {
        return static_cast<Shape>(i);
      }
    }
    fail("problem line: '", word, "' names no shape: point, sphere and capsule are known");
  } else {
    if (value.empty() || value.find_first_not_of("0123456789.e+-") != std::string::npos) {
      fail("problem line: '", word, "' is not of the form name=number");
    }
    if constexpr (std::is_same_v<Value, bool>) {
      return value == "1";
    } else if constexpr (std::is_same_v<Value, int>) {
      return std::stoi(value);
    } else if constexpr (std::is_same_v<Value, double>) {
      return std::stod(value);
    } else {
      return std::stoull(value);
    }
  }
}

}  // namespace

std::string to_line(const RandomOptions& options) {
  std::ostringstream line;
  line.precision(17);
  line << "seed=" << options.seed;
  for_each_field(options, [&line](const char* name, const auto& field) {
    if (!field) {
      return;
    }
    line << ' ' << name << '=';
    if constexpr (std::is_same_v<std::decay_t<decltype(*field)>, Shape>) {
      line << kShapes.at(static_cast<std::size_t>(*field));
    } else {
      line << *field;
    }
  });
  return line.str();
}

RandomOptions parse_options(const std::string& line) {
  RandomOptions options;
  std::istringstream words(line);
  for (std::string word; words >> word;) {
    const std::size_t at = word.find('=');
    const std::string name = word.substr(0, at);
    const std::string value = at == std::string::npos ? "" : word.substr(at + 1);
    bool known = name == "seed";
    if (known) {
      options.seed = parse_value<std::uint64_t>(word, value);
    }
    for_each_field(options, [&](const char* field_name, auto& field) {
      if (name == field_name) {
        field = parse_value<std::decay_t<decltype(*field)>>(word, value);
        known = true;
      }
    });
    if (!known) {
      fail("problem line: '", word, "' is unknown");
    }
  }
  return options;
}

}  // namespace depthgrid::reference
