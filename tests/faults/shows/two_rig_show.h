#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "tests/faults/impaired_road.h"
#include "tests/support/child_program.h"
#include "tests/support/data_folder.h"

namespace vantage {

/// Two tiny rigs, "far" at the other end of a road and "near" on this computer, and a host; each a
/// process.
class TwoRigShow : public testing::Test {
  protected:
    // stage.toml but for its rigs.
    static constexpr const char* stage_head =
        "version = 1\nrate_hz = 5\nlatency_budget_ms = 400\nkey_file = \"host.key\"\n";
    static constexpr const char* stage_view = "[view]\nwidth_px = 96\nheight_px = 64\n";

    void SetUp() override;
    void TearDown() override;

    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

    std::unique_ptr<ChildProgram> start_rig(const std::string& name, double azimuth_deg,
                                            const std::string& stream);
    std::unique_ptr<ChildProgram> start_far();
    void start_host(const std::vector<std::string>& options,
                    const std::string& stage = "stage.toml");

    template <class Condition>
    static bool comes(Condition condition) {
        for (int i = 0; i < 12000; ++i) {
            if (condition()) return true;
            usleep(10'000);
        }
        return false;
    }
    static void wait_for(const ChildProgram& program, const std::string& words);
    /// The host's last word of the far rig's connection.
    bool far_is(const std::string& state) const;
    /// In the host's log.
    std::size_t count_of(const std::string& words) const;
    std::size_t progress() const { return count_of(" pictures, "); }
    void wait_for_progress();

    /// Who waited for a rig, a network or a person would miss ten a second.
    static void expect_ticks_held(const nlohmann::json& summary);
    static void expect_balanced(const nlohmann::json& rig);
    /// Ends a rig, which has counted every frame that it filmed.
    static void expect_unharmed(ChildProgram& rig);

    TemporaryFolder folder_;
    int clock_set_ms_ = 1000;  ///< by which a rig that is started from now on has its clock set
    std::unique_ptr<ImpairedRoad> road_;
    std::string near_endpoint_;
    std::unique_ptr<ChildProgram> far_, near_, host_;
};

}  // namespace vantage
