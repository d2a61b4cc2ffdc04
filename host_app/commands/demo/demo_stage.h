#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <toml++/toml.h>

namespace vantage {

/// What the demo plays on this computer, rigs and host.
struct DemoSize {
    double rate_hz = 25;
    int latency_budget_ms = 200;
    std::string rate = "50", preset = "balanced";  ///< rate: of the programme
    std::array<int, 2> picture = {1920, 1080}, rig = {960, 720};
    int disparities = 96;
    /// The processor draws everything; the rigs draw the stage's loop before they begin.
    bool is_software = false;
};

/// Of every second that a GPU has, what the rigs' matching may take: the rest is the host's.
inline constexpr double matching_ms_a_second = 500;

/// For a processor that draws everything, at the most pulses a second that the demo asks of one.
DemoSize software_demo_size();

/// The pulses a second at which that processor has time for the host beside so many rigs. Beyond
/// them the host leaves instants out, and those that it shows are later. `match_ms`: what a pair
/// takes.
double software_rate_hz(int rigs, double match_ms);

/// The largest size for a GPU of which so many rigs' matching leaves half of its time to the host;
/// the smallest where none does. `match_ms`: what a rig of that size takes for a pair.
DemoSize gpu_demo_size(int rigs, const std::function<double(const DemoSize&)>& match_ms);

/// Files of a stage whose rigs are processes of this computer: keys that are new at every start,
/// a configuration a rig, the host's.
class DemoStage {
  public:
    /// Makes the folder, and deletes keys and configurations that an earlier demo left there.
    /// `kept`: folder for the rigs' own takes; empty: they keep none. Throws Error where it cannot
    /// be written.
    DemoStage(std::filesystem::path folder, std::filesystem::path kept);

    /// `parts`: [source] and what else differs from rig to rig.
    void add_rig(const std::string& name, toml::table parts);
    /// Writes the host's part, once all rigs are there.
    void write(const DemoSize& size) const;

    /// A file of the folder.
    void write(const std::string& name, const toml::table& table) const;

    const std::filesystem::path& folder() const { return folder_; }
    std::filesystem::path stage_file() const { return folder_ / "stage.toml"; }
    const std::vector<std::string>& rigs() const { return names_; }
    std::filesystem::path rig_file(const std::string& name) const {
        return folder_ / (name + ".toml");
    }

  private:
    std::filesystem::path folder_, kept_;
    std::vector<std::string> names_;
    toml::array rigs_;
};

}  // namespace vantage
