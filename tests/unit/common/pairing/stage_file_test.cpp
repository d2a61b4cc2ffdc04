#include "host_app/setup/stage_file.h"

#include <gtest/gtest.h>

#include "common/base/files/atomic_file.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

struct StageFileTest : testing::Test {
    TemporaryFolder folder;
    std::filesystem::path path = folder.path() / "new/stage.toml";

    static StageConfig::Rig rig(const char* name) {
        return {name, "tcp://10.0.0.5:5600", generate_curve_keys().public_key};
    }
};

TEST_F(StageFileTest, IsCreatedWithKeysAndGetsRigs) {
    StageFile file(path);
    EXPECT_FALSE(file.is_there());
    const CurveKeys keys = file.host_keys();
    const StageConfig::Rig north = rig("north");
    file.add(north, 25);
    file.add(rig("south"), 30);
    const StageConfig stage = load_stage_config(path);
    ASSERT_EQ(stage.rigs.size(), 2u);
    EXPECT_EQ(stage.rigs[0].public_key, north.public_key);
    EXPECT_EQ(stage.rigs[1].name, "south");
    EXPECT_EQ(stage.rate_hz, 25) << "the first rig's";
    EXPECT_EQ(load_key_file(stage.key_file).public_key, keys.public_key);
    EXPECT_EQ(StageFile(path).host_keys().public_key, keys.public_key);
}

TEST_F(StageFileTest, KeepsExistingText) {
    const std::string text =
        "# mine\nversion = 1\n[[rigs]]\nname = \"a\"\nendpoint = \"tcp://127.0.0.1:5600\"\n"
        "[view]\nwidth_px = 640   # small";
    const std::filesystem::path mine = folder.path() / "stage.toml";
    write_text_atomically(mine, text);
    StageFile file(mine);
    file.host_keys();
    file.add(rig("b"), 30);
    const StageConfig stage = load_stage_config(mine);
    EXPECT_EQ(stage.rigs.size(), 2u);
    EXPECT_EQ(stage.view.width_px, 640);
    EXPECT_EQ(stage.key_file, folder.path() / "host.key");
    const std::string now = read_text_file(mine, 4096);
    for (const char* kept : {"# mine\n", "# small\n"})
        EXPECT_NE(now.find(kept), std::string::npos) << now;
}

TEST_F(StageFileTest, IsUnchangedIfARigCannotBeAdded) {
    StageFile file(path);
    file.host_keys();
    file.add(rig("north"), 30);
    const std::string before = read_text_file(path, 4096);
    EXPECT_NE(thrown_sentence([&] { file.add(rig("north"), 30); }).find("a second time"),
              std::string::npos);
    EXPECT_EQ(read_text_file(path, 4096), before);
    EXPECT_FALSE(std::filesystem::exists(path.string() + ".new"));
}

}  // namespace
}  // namespace vantage
