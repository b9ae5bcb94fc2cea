// A library of a camera's maker, loaded when a cell wants that camera: nothing is needed to build without it. Private.
#pragma once

#include <span>
#include <string>
#include <type_traits>

namespace depthgrid::sensors {

/// - Threads: any, after construction.
/// - The library stays loaded until the program ends: its threads may outlive whoever opened it.
class SharedLibrary {
 public:
  /// The first of `names` that the system's loader finds: file names, looked for as the loader does, or paths. Throws
  /// Error with what was tried and `hint`, one line, where none is found.
  SharedLibrary(std::span<const std::string> names, const std::string& hint);

  [[nodiscard]] const std::string& name() const noexcept { return name_; }

  /// Throws Error where the library has no such function: it is too old, or another one.
  template <class Function>
  void get(const char* symbol, Function*& function) const {
    static_assert(std::is_function_v<Function>);
    function = reinterpret_cast<Function*>(find(symbol, true));  // NOLINT(*reinterpret-cast): what dlsym is for
  }

  /// Null where the library has no such function.
  template <class Function>
  void get_if(const char* symbol, Function*& function) const {
    static_assert(std::is_function_v<Function>);
    function = reinterpret_cast<Function*>(find(symbol, false));  // NOLINT(*reinterpret-cast)
  }

 private:
  [[nodiscard]] void* find(const char* symbol, bool is_needed) const;

  std::string name_;
  void* handle_ = nullptr;
};

}  // namespace depthgrid::sensors
