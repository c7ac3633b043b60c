// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.h"
#include "meniscus/core/error.h"
#include "meniscus/core/version.h"
#include "meniscus/scene/nearest_name.h"

#include <oneapi/tbb/global_control.h>

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <new>

namespace meniscus::tools {
namespace {

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(verb->get_name());
  return names;
}

std::vector<std::string> flag_names(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// "; did you mean "x"?" or "; see <help>".
std::string suggestion(const std::string& word, const std::vector<std::string>& names, const std::string& help) {
  const std::string nearest = nearest_name(word, names);
  return nearest.empty() ? "; see " + help : fmt::format("; did you mean \"{}\"?", nearest);
}

/// What is wrong with words that no option took; nothing if there are none.
std::string describe_extras(const CLI::App& app) {
  for (const CLI::App* verb : app.get_subcommands()) {
    const std::string help = fmt::format("meniscus {} --help", verb->get_name());
    const std::vector<std::string> extras = verb->remaining();
    if (verb->get_prefix_command() && !extras.empty() && extras.front()[0] != '-') continue;  // another program's own
    for (const std::string& word : extras)
      if (word.size() > 1 && word[0] == '-')
        return fmt::format("{}: unknown option \"{}\"{}", verb->get_name(), word,
                           suggestion(word.substr(0, word.find('=')), flag_names(*verb), help));
    if (!extras.empty())
      return fmt::format("{}: \"{}\" is one argument too many; see {}", verb->get_name(), extras.front(), help);
  }
  return {};
}

[[noreturn]] void refuse_first_word(const CLI::App& app, const std::string& word) {
  if (word[0] == '-')
    throw UsageError(
        fmt::format("unknown option \"{}\"{}", word, suggestion(word, {"--help", "--version"}, "meniscus --help")));
  throw UsageError(fmt::format("unknown verb \"{}\"{}", word, suggestion(word, verb_names(app), "meniscus --help")));
}

/// Reads the command line; throws UsageError. A request for help or the version is a CLI::Success.
void parse(CLI::App& app, int argc, char** argv) {
  if (argc < 2)
    throw UsageError("name a verb: " + fmt::format("{}", fmt::join(verb_names(app), ", ")) + "; see meniscus --help");
  const std::string first = argv[1];
  const std::vector<std::string> verbs = verb_names(app);
  const bool is_verb = std::find(verbs.begin(), verbs.end(), first) != verbs.end();
  if (!is_verb && first != "-h" && first != "--help" && first != "--version") refuse_first_word(app, first);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success&) {
    throw;
  } catch (const CLI::ParseError& error) {
    const std::string extras = describe_extras(app);
    throw UsageError(extras.empty() ? fmt::format("{}: {}; see meniscus {} --help", first, error.what(), first)
                                    : extras);
  }
  if (first != "merge")
    if (const std::string extras = describe_extras(app); !extras.empty()) throw UsageError(extras);
}

/// Throws UsageError if a report or a page would replace a file that the command line names for something else.
void check_reports_are_apart(const CLI::App& app) {
  for (const CLI::App* verb : app.get_subcommands())
    for (const char* name : {"--json", "--html"}) {
      const CLI::Option* report = verb->get_option_no_throw(name);
      if (!report || report->count() == 0 || report->as<std::string>() == "-") continue;
      const std::string file = report->as<std::string>();
      std::vector<std::string> others = verb->remaining();
      for (const CLI::Option* option : verb->get_options())
        if (option != report) others.insert(others.end(), option->results().begin(), option->results().end());
      for (const std::string& other : others)
        if (is_same_file(file, other))
          throw UsageError(
              fmt::format("{} {}: the command line names that file for something else, too, which would be "
                          "lost; choose another name",
                          name, file));
    }
}

std::unique_ptr<tbb::global_control> limit_threads(const CLI::App& app) {
  for (const CLI::App* verb : app.get_subcommands())
    if (const CLI::Option* threads = verb->get_option_no_throw("--threads"); threads && threads->count() > 0)
      return std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                   threads->as<std::size_t>());
  return nullptr;
}

int run_command(int argc, char** argv) {
  Run run;
  CLI::App app("Drops of liquid as closed triangle meshes. Lengths in cm, time in s, angles in degrees.", "meniscus");
  app.set_version_flag("--version", "meniscus " + version());
  app.formatter(overview_formatter());
  app.require_subcommand(1);
  add_check(app, run);
  add_convert(app, run);
  add_remesh(app, run);
  add_merge(app, run);
  add_split(app, run);
  add_flow(app, run);
  add_evolve(app, run);
  add_view(app, run);
  add_schema(app, run);
  add_bench(app, run);
  app.footer(
      "meniscus VERB --help tells more of a verb. Exit codes: 0 done; 1 check found defects; 2 usage or scene\n"
      "error; 3 a file cannot be read or written; 4 the geometry was refused; 5 the numerics failed;\n"
      "130 interrupted.");
  try {
    parse(app, argc, argv);
  } catch (const CLI::Success& success) {
    return app.exit(success);
  }
  check_reports_are_apart(app);
  const auto threads = limit_threads(app);
  return run();
}

/// The reader of our output has gone: nothing to say, and nobody to say it to.
bool is_reader_gone() {
  pollfd out{STDOUT_FILENO, 0, 0};
  return !std::cout && ::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

int fail(int code, const std::exception& error) {
  say_error(error.what());
  return code;
}

}  // namespace
}  // namespace meniscus::tools

int main(int argc, char** argv) {
  using namespace meniscus;
  std::signal(SIGPIPE, SIG_IGN);
  try {
    return tools::run_command(argc, argv);
  } catch (const UsageError& error) {
    return tools::fail(2, error);
  } catch (const FileError& error) {
    return tools::is_reader_gone() ? 3 : tools::fail(3, error);
  } catch (const GeometryError& error) {
    return tools::fail(4, error);
  } catch (const NumericsError& error) {
    return tools::fail(5, error);
  } catch (const std::filesystem::filesystem_error& error) {
    const std::string reason = error.code().message();
    tools::say_error(fmt::format("{}: {}; check the name and its permissions", error.path1().string(), reason));
    return 3;
  } catch (const std::bad_alloc&) {
    tools::say_error("out of memory; use a smaller mesh or a coarser band");
    return 5;
  } catch (const std::exception& error) {
    tools::say_error(std::string("internal error, please report it: ") + error.what());
    return 5;
  }
}
