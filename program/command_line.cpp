#include "program/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "depthgrid/core/printable_text.hpp"
#include "program/interruption.hpp"
#include "program/usage_error.hpp"

namespace depthgrid::program {
namespace {

constexpr int kFailed = 1;
constexpr int kUsage = 2;

/// One line on standard error, whatever the message holds: nothing in it steers the terminal.
int report(const CLI::App& app, const std::string& message, int exit_code) {
  const std::string line = app.get_name() + ": " + printable(message) + "\n";
  (void)std::fputs(line.c_str(), stderr);
  return exit_code;
}

/// For CLI11: empty, or what is wrong with a value.
std::string no_value(const std::string& value) { return value.empty() ? "must not be empty" : ""; }

/// An option with an empty value is a slip (an unset variable of a script) and not the option's absence.
void refuse_empty_values(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_expected_max() > 0) {
      option->check(CLI::Validator(no_value, ""));
    }
  }
  for (CLI::App* command : app.get_subcommands([](CLI::App*) { return true; })) {
    refuse_empty_values(*command);
  }
}

/// The command that the words lead to; `words` is how it is called.
const CLI::App& innermost(const CLI::App& app, std::string& words) {
  const std::vector<CLI::App*> chosen = app.get_subcommands();
  words += (words.empty() ? "" : " ") + app.get_name();
  return chosen.empty() ? app : innermost(*chosen.front(), words);
}

/// Words that no command and no option took, also where --help or --version would hide them.
void refuse_leftovers(const CLI::App& app) {
  const std::vector<std::string> left = app.remaining(true);
  if (left.empty()) {
    return;
  }
  std::string words;
  const CLI::App& command = innermost(app, words);
  const auto unknown =
      std::find_if(left.begin(), left.end(), [](const std::string& word) { return word.rfind('-', 0) != 0; });
  if (command.get_require_subcommand_min() > 0 && unknown != left.end()) {
    const std::string whole = words + " " + *unknown;
    fail_usage("there is no command '", whole.substr(app.get_name().size() + 1), "' (", words, " --help lists them)");
  }
  throw CLI::ExtrasError(app.get_name(), left);
}

int run(CLI::App& app, int argc, char** argv) {
  try {
    try {
      app.parse(argc, argv);
    } catch (const CLI::Success& request) {  // --help and --version
      refuse_leftovers(app);
      return app.exit(request);
    } catch (const CLI::ParseError&) {
      refuse_leftovers(app);
      throw;
    }
  } catch (const CLI::ParseError& error) {
    return report(app, error.what() + (" (" + app.get_name() + " --help explains)"), kUsage);
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
    end_tidily_on_signals(app.get_name());
    refuse_empty_values(app);
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
