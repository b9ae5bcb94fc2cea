// Prints a header that makes the odd rigs and settings again: the test compiles it.
#include <iostream>

#include "views/odd_settings.hpp"

namespace {

template <class Value>
void print(const char* type, const char* name, const std::vector<Value>& values) {
  std::cout << "inline std::vector<" << type << "> " << name << "() {\n  return {\n";
  for (const Value& value : values) {
    std::cout << "    " << to_string(value) << ",\n";
  }
  std::cout << "  };\n}\n\n";
}

}  // namespace

int main() {
  std::cout << "#pragma once\n\n#include \"views/odd_settings.hpp\"\n\n";
  print("depthgrid::Rig", "printed_rigs", depthgrid::views::odd_rigs());
  print("depthgrid::views::Settings", "printed_settings", depthgrid::views::odd_settings());
  return 0;
}
