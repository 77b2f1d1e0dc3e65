// SPDX-License-Identifier: Apache-2.0
#include "host/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string_view>
#include <type_traits>

#include "base/not_yet_error.hpp"
#include "host/event.hpp"
#include "host/rank_output.hpp"
#include "host/regular_file.hpp"
#include "host/worker_pool.hpp"

namespace host {

Option Option::required() const {
    option_->required();
    return *this;
}

Option Option::showDefault() const {
    option_->capture_default_str();
    listed_->fallback = option_->get_default_str();
    return *this;
}

Option Option::fallback(const std::string& text) const {
    option_->default_str(text);
    listed_->fallback = text;
    return *this;
}

Option Option::range(int lowest, int highest) const {
    option_->check(CLI::Range(lowest, highest));
    listed_->least = lowest;
    listed_->most = highest;
    return *this;
}

Option Option::range(double lowest, double highest) const {
    option_->check(CLI::Range(lowest, highest));
    listed_->least = lowest;
    listed_->most = highest;
    return *this;
}

Option Option::positive() const {
    option_->check(CLI::PositiveNumber);
    listed_->least = 0;
    listed_->aboveLeast = true;
    return *this;
}

Option Option::notNegative() const {
    option_->check(CLI::NonNegativeNumber);
    listed_->least = 0;
    return *this;
}

Option Option::oneOf(const std::vector<std::string>& allowed) const {
    option_->check(CLI::IsMember(allowed));
    listed_->values = allowed;
    return *this;
}

Option Option::check(std::function<std::string(const std::string&)> refusal) const {
    option_->check(std::move(refusal));
    return *this;
}

Option Option::oneValueEach() const {
    option_->allow_extra_args(false);
    listed_->several = true;
    return *this;
}

Option Option::commaSeparated() const {
    option_->delimiter(',');
    return *this;
}

Option Option::needs(const Option& other) const {
    option_->needs(other.option_);
    return *this;
}

Option Option::excludes(const Option& other) const {
    option_->excludes(other.option_);
    listed_->excludes.push_back(other.listed_->name);
    return *this;
}

Option Option::metavar(const std::string& word) const {
    option_->type_name(word);
    listed_->metavar = word;
    return *this;
}

Option Option::beginnings(const std::vector<std::string>& words) const {
    listed_->beginnings = words;
    return *this;
}

Option Option::offeredBy(const std::vector<std::string>& commands) const {
    listed_->offeredBy = commands;
    return *this;
}

CommandLine::CommandLine(const std::string& what, const std::string& name)
    : owned_(std::make_unique<CLI::App>(what, name)), app_(owned_.get()), list_(std::make_shared<OptionList>()) {
    list_->name = name;
    list_->what = what;
    keepOthersFromWriting();  // here, because every program makes its command line before it starts anything
    // Only for --help, because host::answersVersion() answers --version before the program starts anything.
    app_->add_flag_callback(
        "--version", [] {}, "print version and build, with --json as JSON, and end");
}

CommandLine::CommandLine(CLI::App* command, std::shared_ptr<OptionList> list) : app_(command), list_(std::move(list)) {}
CommandLine::~CommandLine() = default;
CommandLine::CommandLine(CommandLine&&) noexcept = default;

namespace {

template <class T>
constexpr bool kIsReal = std::is_same_v<T, double> || std::is_same_v<T, std::optional<double>>;

template <class T>
constexpr bool kIsText = std::is_constructible_v<T, const char*> || std::is_same_v<T, std::vector<std::string>>;

template <class T>
constexpr bool kIsVector = std::is_same_v<T, std::vector<std::string>> || std::is_same_v<T, std::vector<int>>;

/// Returns why `text` is not a finite number. Returns an empty text for a finite number, and for a text that is not a
/// number, which the conversion refuses.
std::string notFinite(const std::string& text) {
    double number = 0;
    const bool finite = !CLI::detail::lexical_cast(text, number) || std::isfinite(number);
    return finite ? "" : "must be a finite number, got " + text;
}

constexpr std::string_view kOptionsJson = "--options-json";

bool isGiven(std::string_view option, int argc, char** argv) {
    return std::any_of(argv + std::min(argc, 1), argv + argc, [option](const char* word) { return option == word; });
}

}  // namespace

template <class T>
Option CommandLine::option(const std::string& name, T& value, const std::string& help) {
    CLI::Option* option = app_->add_option(name, value, help);
    if constexpr (kIsReal<T>) {
        option->check(notFinite);  // because CLI11 converts "nan" and "inf", and its ranges let NaN pass
    }
    return listed(option, name, kIsReal<T> ? "number" : kIsText<T> ? "text" : "integer", kIsVector<T>, help);
}

template Option CommandLine::option(const std::string&, std::string&, const std::string&);
template Option CommandLine::option(const std::string&, int&, const std::string&);
template Option CommandLine::option(const std::string&, std::uint16_t&, const std::string&);
template Option CommandLine::option(const std::string&, std::uint32_t&, const std::string&);
template Option CommandLine::option(const std::string&, std::uint64_t&, const std::string&);
template Option CommandLine::option(const std::string&, std::int64_t&, const std::string&);
template Option CommandLine::option(const std::string&, double&, const std::string&);
template Option CommandLine::option(const std::string&, std::vector<std::string>&, const std::string&);
template Option CommandLine::option(const std::string&, std::vector<int>&, const std::string&);
template Option CommandLine::option(const std::string&, std::optional<std::uint64_t>&, const std::string&);
template Option CommandLine::option(const std::string&, std::optional<std::int64_t>&, const std::string&);
template Option CommandLine::option(const std::string&, std::filesystem::path&, const std::string&);
template Option CommandLine::option(const std::string&, std::optional<double>&, const std::string&);
template Option CommandLine::option(const std::string&, std::optional<int>&, const std::string&);
template Option CommandLine::option(const std::string&, std::optional<std::string>&, const std::string&);

Option CommandLine::flag(const std::string& name, bool& value, const std::string& help) {
    return listed(app_->add_flag(name, value, help), name, "flag", false, help);
}

Option CommandLine::listed(CLI::Option* option, const std::string& name, const char* kind, bool several,
                           const std::string& help) const {
    ListedOption& entry = list_->options.emplace_back();
    entry.name = name;
    entry.kind = kind;
    entry.help = help;
    entry.several = several;
    return {option, &entry};
}

Option CommandLine::chosen(const std::string& name, const std::vector<std::string>& names,
                           std::function<void(std::size_t)> take, const std::string& help) {
    const auto taken = [names, take = std::move(take)](const std::string& value) {
        take(static_cast<std::size_t>(std::find(names.begin(), names.end(), value) - names.begin()));
    };
    return listed(app_->add_option_function<std::string>(name, taken, help), name, "text", false, help).oneOf(names);
}

Option CommandLine::named(const std::string& name) const {
    const auto entry = std::find_if(list_->options.begin(), list_->options.end(),
                                    [&name](const ListedOption& option) { return option.name == name; });
    return {app_->get_option(name), &*entry};
}

CommandLine CommandLine::command(const std::string& name, const std::string& what) {
    app_->require_subcommand(1);
    OptionList& command = list_->commands.emplace_back();
    command.name = name;
    command.what = what;
    return {app_->add_subcommand(name, what), std::shared_ptr<OptionList>(list_, &command)};
}

void CommandLine::words(const std::string& list, std::vector<std::string> words) {
    list_->words.emplace_back(list, std::move(words));
}

bool CommandLine::given() const { return app_->parsed(); }

std::string CommandLine::name() const { return app_->get_name(); }

void CommandLine::footer(const std::string& text) { app_->footer(text); }

bool CommandLine::answersHelp(int argc, char** argv) const {
    if (isGiven("--help", argc, argv) || isGiven("-h", argc, argv)) {
        std::fputs(app_->help().c_str(), stdout);
        return true;
    }
    if (isGiven(kOptionsJson, argc, argv)) {
        std::puts(list_->json().c_str());
        return true;
    }
    return false;
}

std::optional<int> CommandLine::parse(int argc, char** argv) {
    if (isGiven(kOptionsJson, argc, argv)) {
        std::puts(list_->json().c_str());
        return 0;
    }
    try {
        app_->parse(argc, argv);
        if (const std::string why = whyBadEventsVariable(); !why.empty()) {
            writeLine(app_->get_name() + ": " + base::InputError(why).what() + "\n");
            return base::kExitBadInput;
        }
        return std::nullopt;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) {
            return app_->exit(error);  // --help
        }
        writeLine(app_->get_name() + ": " + error.what() + "; try --help\n");
        return base::kExitBadInput;
    }
}

Option addSandThreads(CommandLine& line, int& threads) {
    return line
        .option("--sand-threads", threads,
                "threads that sweep the sand (default: 1); the sand is the same with any number")
        .metavar("N")
        .range(1, kMostThreads);
}

int runMain(CommandLine& line, int argc, char** argv, const std::function<int()>& run, int failed) {
    if (const std::optional<int> status = line.parse(argc, argv)) {
        return *status;
    }
    try {
        return run();
    } catch (const base::InputError& error) {
        writeLine(line.name() + ": " + error.what() + "\n");
        return dynamic_cast<const base::NotYetError*>(&error) == nullptr ? base::kExitBadInput : base::kExitNotYet;
    } catch (const std::exception& error) {
        writeLine(line.name() + ": failed: " + error.what() + "\n");
        return failed;
    }
}

}  // namespace host
