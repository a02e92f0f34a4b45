#include <priormap/cli/tool_app.hpp>

#include <malloc.h>
#include <pthread.h>
#include <signal.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <iostream>
#include <map>
#include <new>
#include <string_view>
#include <thread>

#include <priormap/core/error.hpp>
#include <priormap/core/parallel.hpp>
#include <priormap/core/version.hpp>

#include "config_file.hpp"
#include "console.hpp"
#include "nearest_name.hpp"
#include "option_value.hpp"
#include "toml.hpp"

namespace priormap::cli {
namespace {

constexpr int exit_failed = 1;
constexpr int exit_usage = 2;

using Texts = std::vector<std::string>;

/// A signal must not leave temporary outputs behind. Handlers may not touch files, so one thread waits for the signals
/// that all others block.
void clean_up_on_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  std::thread([signals] {
    int signal = 0;
    sigwait(&signals, &signal);
    discard_pending_outputs();
    ::_exit(128 + signal);
  }).detach();
}

/// Buffers of a few MB come and go with each tile or scan. glibc would give their memory back each time and fetch it page by page again,
/// which took a fifth of dsm2prior's time.
void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 8 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
}

std::string type_name(const char* kind, const OptionField& field) {
  return field.unit.empty() ? kind : std::string(field.unit);
}

std::string join(const std::vector<std::string>& items, const std::string& separator) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : separator) + item;
  return text;
}

std::string toml_array(const std::vector<std::string>& literals) { return "[" + join(literals, ", ") + "]"; }

std::vector<std::string> number_literals(const std::vector<double>& values) {
  std::vector<std::string> literals;
  for (const double value : values) literals.push_back(number_text(value));
  return literals;
}

/// A word of the command line that asks for an option: a number below zero does not.
bool asks_for_option(const std::string& word) {
  const auto letter = word.find_first_not_of('-');
  return letter != 0 && letter != std::string::npos && std::isalpha(static_cast<unsigned char>(word[letter]));
}

std::vector<std::string> string_literals(const std::vector<std::string>& values) {
  std::vector<std::string> literals;
  for (const std::string& value : values) literals.push_back(toml_string(value));
  return literals;
}

}  // namespace

struct ToolApp::Impl {
  struct Dumped {
    std::string key;
    std::function<std::optional<std::string>()> literal;  // nothing where the option is not set
  };

  Impl(std::string tool_name, std::string description) : name(tool_name), app(std::move(description), std::move(tool_name)) {}

  /// One option whose texts `read` turns into the value.
  CLI::Option* add(const std::string& flags, const std::function<void(const Texts&)>& read, const std::string& help,
                   const std::string& type, const std::string& default_text,
                   std::function<std::optional<std::string>()> literal) {
    const auto callback = [this, read, shown = first_name(flags)](const Texts& texts) {
      try {
        read(texts);
      } catch (const UsageError& error) {
        throw CLI::ValidationError(place_in_config(shown) + shown, error.what());
      }
      return true;
    };
    CLI::Option* option = app.add_option(flags, callback, help);
    option->type_name(type)->group(group);
    if (!default_text.empty()) option->default_str(default_text);
    remember(option, std::move(literal));
    return option;
  }

  CLI::Option* add_flag(const std::string& flags, bool& value, const std::string& help) {
    CLI::Option* option = app.add_flag(flags, value, help)->group(group);
    remember(option, [&value] { return std::string(value ? "true" : "false"); });
    return option;
  }

  void remember(const CLI::Option* option, std::function<std::optional<std::string>()> literal) {
    dumped.push_back({option->get_single_name(), std::move(literal)});
  }

  static std::string first_name(const std::string& flags) {
    const auto start = flags.find("--");
    return start == std::string::npos ? flags : flags.substr(start, flags.find(',', start) - start);
  }

  std::string config_name() const { return app.get_config_ptr()->as<std::string>(); }

  /// "FILE: line N: " where the value comes from there.
  std::string place_in_config(const std::string& shown) const {
    const auto line = config_lines.find(shown);
    return line == config_lines.end() ? "" : config_name() + ": line " + std::to_string(line->second) + ": ";
  }

  /// A slip of the keyboard is named before what is missing because of it.
  void refuse_unknown_options(int argc, char** argv) const {
    const std::vector<std::string> left = app.remaining();
    for (int i = 1; i < argc; ++i) {
      const std::string word = argv[i];
      if (!asks_for_option(word) || std::find(left.begin(), left.end(), word) == left.end()) continue;
      const std::string asked = word.substr(0, word.find('=')), bare = asked.substr(asked.find_first_not_of('-'));
      throw CLI::ParseError("there is no option " + asked + meant(bare, long_names(app), "--"), CLI::ExitCodes::ExtrasError);
    }
  }

  void parse(int argc, char** argv) {
    const bool has_positionals = !app.get_options([](const CLI::Option* option) { return option->get_positional(); }).empty();
    for (CLI::Option* list : number_lists) list->allow_extra_args(!has_positionals);   // 1 2 3 for 1,2,3 where nothing else could be meant
    try {
      app.parse(argc, argv);
    } catch (const CLI::ExtrasError&) {
      refuse_unknown_options(argc, argv);
      throw;
    } catch (const CLI::RequiredError&) {
      refuse_unknown_options(argc, argv);
      if (!dump) throw;
      for (CLI::Option* option : app.get_options()) option->required(false);
      app.parse(argc, argv);
    }
  }

  std::string config_text() const {
    std::string text;
    for (const Dumped& option : dumped)
      if (const auto literal = option.literal()) text += option.key + " = " + *literal + "\n";
    return text;
  }

  std::string name;
  CLI::App app;
  std::string group = "Options";
  std::vector<Dumped> dumped;
  std::vector<CLI::Option*> number_lists;
  std::map<std::string, int> config_lines;
  int threads = 0;
  bool overwrite = false, quiet = false, log_json = false, dump = false;
};

ToolApp::ToolApp(std::string name, std::string description) : impl_(std::make_unique<Impl>(std::move(name), std::move(description))) {
  impl_->app.get_formatter()->column_width(36);
}

ToolApp::~ToolApp() = default;

void ToolApp::positional(const std::string& name, std::vector<std::string>& values, const std::string& help, bool required) {
  impl_->add(name, [&values](const Texts& texts) { values = texts; }, help, "", "",
             [&values]() -> std::optional<std::string> {
               if (values.empty()) return std::nullopt;
               return toml_array(string_literals(values));
             })
      ->expected(1, CLI::detail::expected_max_vector_size)
      ->allow_extra_args()
      ->required(required);
}

void ToolApp::positional(const std::string& name, std::string& value, const std::string& help, bool required) {
  impl_->add(name, [&value](const Texts& texts) { value = texts.front(); }, help, "", value,
             [&value]() -> std::optional<std::string> {
               if (value.empty()) return std::nullopt;
               return toml_string(value);
             })
      ->required(required);
}

void ToolApp::required(const std::string& flags, std::string& value, const std::string& help) {
  option(flags, value, {help});
  impl_->app.get_options().back()->required();
}

void ToolApp::flag(const std::string& flags, bool& value, const std::string& help) { impl_->add_flag(flags, value, help); }

void ToolApp::choice(const std::string& flags, std::string& value, const std::vector<std::string>& allowed,
                     const std::string& help) {
  const std::string list = join(allowed, "|");
  impl_->add(
      flags,
      [&value, allowed, list](const Texts& texts) {
        if (std::find(allowed.begin(), allowed.end(), texts.front()) == allowed.end())
          throw UsageError("'" + texts.front() + "' is none of " + list);
        value = texts.front();
      },
      help, list, value, [&value] { return toml_string(value); });
}

void ToolApp::option(const std::string& flags, double& value, const OptionField& field) {
  impl_->add(flags, [&value, field](const Texts& texts) { value = parse_number(texts.front(), field); },
             std::string(field.help), type_name("NUMBER", field), number_text(value), [&value] { return number_text(value); });
}

void ToolApp::option(const std::string& flags, int& value, const OptionField& field) {
  OptionField bounded = field;
  bounded.min = std::max<double>(field.min, std::numeric_limits<int>::min());
  bounded.max = std::min<double>(field.max, std::numeric_limits<int>::max());
  impl_->add(flags, [&value, bounded](const Texts& texts) { value = static_cast<int>(parse_integer(texts.front(), bounded)); },
             std::string(field.help), type_name("N", field), std::to_string(value), [&value] { return std::to_string(value); });
}

void ToolApp::option(const std::string& flags, std::uint64_t& value, const OptionField& field) {
  impl_->add(flags, [&value, field](const Texts& texts) { value = parse_unsigned(texts.front(), field); },
             std::string(field.help), type_name("N", field), std::to_string(value), [&value] { return std::to_string(value); });
}

void ToolApp::option(const std::string& flags, bool& value, const OptionField& field) {
  const std::string remark = value ? " (on; " + Impl::first_name(flags) + "=false turns it off)" : "";
  impl_->add_flag(flags, value, std::string(field.help) + remark);
}

void ToolApp::option(const std::string& flags, std::string& value, const OptionField& field) {
  impl_->add(flags, [&value](const Texts& texts) { value = texts.front(); }, std::string(field.help),
             type_name("TEXT", field), value, [&value]() -> std::optional<std::string> {
               if (value.empty()) return std::nullopt;
               return toml_string(value);
             });
}

void ToolApp::option(const std::string& flags, std::vector<std::string>& value, const OptionField& field) {
  impl_->add(flags, [&value](const Texts& texts) { value = texts; }, std::string(field.help), type_name("TEXT", field),
             join(value, " "), [&value]() -> std::optional<std::string> {
               if (value.empty()) return std::nullopt;
               return toml_array(string_literals(value));
             })
      ->expected(1, CLI::detail::expected_max_vector_size)
      ->allow_extra_args(false);
}

void ToolApp::option(const std::string& flags, std::vector<double>& value, const OptionField& field) {
  CLI::Option* list = impl_->add(flags, [&value, field](const Texts& texts) { value = parse_number_list(texts, field); }, std::string(field.help),
                                 type_name("A,B,..", field), join(number_literals(value), ","), [&value]() -> std::optional<std::string> {
                                   if (value.empty()) return std::nullopt;
                                   return toml_array(number_literals(value));
                                 });
  list->expected(1, CLI::detail::expected_max_vector_size)->allow_extra_args(false);
  impl_->number_lists.push_back(list);
}

void ToolApp::option(const std::string& flags, std::optional<double>& value, const OptionField& field) {
  impl_->add(flags, [&value, field](const Texts& texts) { value = parse_number(texts.front(), field); },
             std::string(field.help), type_name("NUMBER", field), value ? number_text(*value) : "",
             [&value]() -> std::optional<std::string> {
               if (!value) return std::nullopt;
               return number_text(*value);
             });
}

void ToolApp::option(const std::string& flags, std::optional<std::string>& value, const OptionField& field) {
  impl_->add(flags, [&value](const Texts& texts) { value = texts.front(); }, std::string(field.help),
             type_name("TEXT", field), value.value_or(""), [&value]() -> std::optional<std::string> {
               if (!value) return std::nullopt;
               return toml_string(*value);
             });
}

void ToolApp::begin_group(const std::string& name) { impl_->group = name.empty() ? "Options" : name; }

int ToolApp::run(int argc, char** argv, const std::function<void(const ToolContext&)>& body) {
  Impl& impl = *impl_;
  CLI::App& app = impl.app;
  impl.group = "Common";
  OptionField threads{"Threads to use; 0: one per core", "", 0, 4096};
  option("--threads", impl.threads, threads);
  impl.add_flag("--overwrite", impl.overwrite, "Replace an existing output");
  impl.add_flag("--quiet", impl.quiet, "Only errors on stderr");
  impl.add_flag("--log-json", impl.log_json, "Messages and progress as one JSON object a line");
  app.set_config("--config", "", "Options from a TOML file; the command line wins")->group(impl.group)->type_name("FILE");
  app.config_formatter(std::make_shared<ConfigFile>(app, impl.config_lines));
  app.allow_config_extras(CLI::config_extras_mode::error);
  app.add_flag("--dump-config", impl.dump, "Print the options in force as a configuration file, and end")
      ->group(impl.group)
      ->configurable(false);
  app.set_version_flag("--version", impl.name + " " + std::string(version), "Print the version, and end")->group(impl.group);
  app.get_help_ptr()->group(impl.group);

  // When the command line is faulty, CLI11 has not set the flags yet.
  const bool json_asked = std::find(argv, argv + argc, std::string_view("--log-json")) != argv + argc;
  const auto fail = [&](const std::string& message, int exit_code) {
    Console(impl.name, impl.quiet, impl.log_json || json_asked).error(message, exit_code);
    return exit_code;
  };

  try {
    impl.parse(argc, argv);
  } catch (const CLI::Success& request) {
    return app.exit(request);
  } catch (const CLI::ParseError& error) {
    return fail(std::string(error.what()) + " (see " + impl.name + " --help)", exit_usage);
  } catch (const UsageError& error) {
    return fail(impl.config_name() + ": " + error.what() + " (see " + impl.name + " --help)", exit_usage);
  }
  if (impl.dump) {
    std::cout << impl.config_text();
    return 0;
  }

  // A write beyond the file size limit is then an error like a full disk, not a kill that leaves temporary files.
  ::signal(SIGXFSZ, SIG_IGN);
  clean_up_on_signals();
  keep_freed_memory();
  Console console(impl.name, impl.quiet, impl.log_json);
  try {
    ToolContext context;
    context.threads = impl.threads > 0 ? impl.threads : default_thread_count();
    context.overwrite = impl.overwrite ? Overwrite::allow : Overwrite::refuse;
    context.events = console.events();
    body(context);
    if (!std::cout.flush()) throw IoError("standard output cannot be written");
    return 0;
  } catch (const UsageError& error) {
    console.error(error.what(), exit_usage);
    return exit_usage;
  } catch (const std::bad_alloc&) {
    console.error("out of memory", exit_failed);
  } catch (const std::exception& error) {
    console.error(error.what(), exit_failed);
  }
  return exit_failed;
}

}  // namespace priormap::cli
