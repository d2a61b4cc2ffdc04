#include "calib_tools/commands/live_option.h"

#include "common/base/error.h"

namespace vantage {

void LiveOption::add_to(CLI::App& command) {
    CLI::Option* live = command.add_option(
        "--live", stage_file,
        "Take the pictures from the running rigs of this stage file (stage.toml) instead of files");
    command
        .add_option("--views", views, "With --live: keep the pictures of at most this many pulses")
        ->check(CLI::Range(3, 1000))
        ->capture_default_str()
        ->needs(live);
    command
        .add_option("--patience-s", patience_s,
                    "With --live: stop after this many seconds without pictures")
        ->check(CLI::Range(1, 3600))
        ->capture_default_str()
        ->needs(live);
}

void LiveOption::add_film_to(CLI::App& command) {
    add_to(command);
    command
        .add_flag("--go-on", go_on,
                  "With --live: continue with the pictures that an earlier run left in the folders")
        ->needs("--live");
}

void LiveRigOption::add_to(CLI::App& command) {
    add_film_to(command);
    command.add_option("--rig", rig,
                       "Calibrate the rig NAME with the pictures in FOLDER, given as NAME=FOLDER; "
                       "--live stores its pictures there first");
}

RigFolder LiveRigOption::folder() const {
    if (rig.empty()) fail("which rig of the stage? give --rig NAME=FOLDER");
    return parse_rig_folders({rig}).front();
}

std::string LiveRigOption::kept_pictures(const std::string& side) const {
    return (folder().folder / (side + "*.png")).string();
}

LiveRigs LiveOption::connect(const std::vector<RigFolder>& rigs, double pictures_per_second) const {
    LiveOptions options;
    options.pictures_per_second = pictures_per_second;
    options.stage_file = stage_file;
    for (const RigFolder& rig : rigs) options.rigs.push_back(rig.name);
    options.patience = std::chrono::seconds(patience_s);
    return LiveRigs(options);
}

}  // namespace vantage
