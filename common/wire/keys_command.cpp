#include "common/wire/keys_command.h"

#include <filesystem>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "common/wire/curve_keys.h"

namespace vantage {
namespace {

struct Options {
    std::filesystem::path file;
    bool json = false;
};

void print_public_key(const Options& options, const CurveKeys& keys) {
    if (options.json)
        std::cout << nlohmann::json{{"file", options.file.string()},
                                    {"public_key", keys.public_key}}
                  << '\n';
    else
        std::cout << keys.public_key << '\n';
}

CLI::App* add_action(CLI::App& parent, const char* name, const char* description, Options& options,
                     const char* file_help) {
    CLI::App* action = parent.add_subcommand(name, description);
    action->add_option("FILE", options.file, file_help)->required();
    action->add_flag("--json", options.json, "Print JSON");
    return action;
}

}  // namespace

void add_keys_command(CLI::App& program) {
    CLI::App* keys = program.add_subcommand(
        "keys", "Create and show the keys with which rigs and hosts authenticate each other");
    keys->require_subcommand(1);
    const auto options = std::make_shared<Options>();
    add_action(*keys, "new", "Create a key pair and print its public key", *options,
               "Write the key pair to this file; an existing file is not replaced")
        ->callback([options] {
            const CurveKeys made = generate_curve_keys();
            write_key_file(options->file, made);
            print_public_key(*options, made);
        });
    add_action(*keys, "show", "Print the public key of a key file", *options, "Read this key file")
        ->callback([options] { print_public_key(*options, load_key_file(options->file)); });
}

}  // namespace vantage
