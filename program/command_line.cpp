#include "program/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "program/usage_error.hpp"

namespace depthgrid::program {
namespace {

constexpr int kFailed = 1;
constexpr int kUsage = 2;

/// One line on standard error, whatever the message holds.
int report(const CLI::App& app, std::string message, int exit_code) {
  std::replace_if(
      message.begin(), message.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  message = app.get_name() + ": " + message + "\n";
  (void)std::fputs(message.c_str(), stderr);
  return exit_code;
}

int run(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& request) {  // --help and --version
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    const std::string help = " (" + app.get_name() + " --help ";
    if (app.get_subcommands().empty() && argc > 1 && argv[1][0] != '-') {
      return report(app, "there is no command '" + std::string(argv[1]) + "'" + help + "lists them)", kUsage);
    }
    return report(app, error.what() + help + "explains)", kUsage);
  } catch (const UsageError& error) {
    return report(app, error.what(), kUsage);
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    return report(app, "standard output cannot be written", kFailed);
  }
  return 0;
}

}  // namespace

int run_command_line(CLI::App& app, int argc, char** argv) noexcept {
  try {
    return run(app, argc, argv);
  } catch (const std::bad_alloc&) {
    return report(app, "out of memory", kFailed);
  } catch (const std::exception& error) {
    return report(app, error.what(), kFailed);
  } catch (...) {
    return report(app, "unknown error", kFailed);
  }
}

}  // namespace depthgrid::program
