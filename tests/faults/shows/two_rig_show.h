#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

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
    /// Nobody else listens where the host is.
    static constexpr int metrics_port = 9464;
    /// Two seconds.
    static constexpr int sets_to_recover = 10;

    /// The far rig's road, of its rig.toml.
    virtual std::string far_road() const { return "tcp"; }

    void SetUp() override;
    void TearDown() override;

    std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

    std::unique_ptr<ChildProgram> start_rig(const std::string& name, double azimuth_deg,
                                            const std::string& stream);
    std::unique_ptr<ChildProgram> start_far();
    void start_host(const std::vector<std::string>& options,
                    const std::string& stage = "stage.toml",
                    const std::vector<std::string>& environment = {});

    /// The host's last word of the far rig's connection.
    bool far_is(const std::string& state) const;
    /// In the host's log.
    std::size_t count_of(const std::string& words) const;
    std::size_t progress() const { return count_of(" frames, "); }
    void wait_for_progress();
    /// The number that follows these words in the host's log, once they are there.
    double named_by_host(const std::string& words) const;
    /// Sets that lacked the far rig after its trouble's end, before it was in every one again.
    /// Counted by the rig beside, so that a slow computer has as much time as it takes to film
    /// them.
    int sets_until_far_is_back(const std::function<void()>& end_trouble);
    /// Frames that another host gets of the near rig after the end of this one's trouble, before
    /// this one's first word, a second later or less, after which both rigs are in every set.
    int frames_beside_until_both_are_back(const std::function<void()>& end_trouble);

    /// Who waited for a rig, a network or a person would miss ten a second.
    static void expect_ticks_held(const nlohmann::json& summary);
    static void expect_balanced(const nlohmann::json& rig);
    /// No rig was out of step or interrupted, and the network lost no frame.
    static void expect_no_frame_lost(const nlohmann::json& summary);
    /// Ends a rig, which has counted every frame that it filmed.
    static void expect_unharmed(ChildProgram& rig);

    TemporaryFolder folder_;
    int clock_set_ms_ = 1000;  ///< by which a rig that is started from now on has its clock set
    std::unique_ptr<ImpairedRoad> road_;
    std::string near_endpoint_;
    std::string far_entry_, near_entry_;  ///< of a stage.toml
    std::unique_ptr<ChildProgram> far_, near_, host_;

  private:
    struct Sets {
        int far = 0, near = 0;
    };
    /// The sets that each rig has been in, both at one moment: the host's next word of them.
    Sets next_frame_sets();

    std::string last_word_;
};

}  // namespace vantage
