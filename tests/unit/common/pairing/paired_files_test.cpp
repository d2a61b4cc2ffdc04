#include "rig_firmware/pairing/paired_files.h"

#include <gtest/gtest.h>

#include "common/base/files/atomic_file.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

struct PairedFilesTest : testing::Test {
    TemporaryFolder folder;
    std::filesystem::path file = folder.path() / "rig.toml";

    void write(const std::string& stream) const {
        write_text_atomically(file, "version = 1\nname = \"north\"   # mine\n" + stream);
    }
    static PairReveal host(const char* name) {
        return {name, generate_curve_keys().public_key, {}};
    }
};

TEST_F(PairedFilesTest, AddsKeyAndListToAConfigurationWithoutThem) {
    write("[stream]\n# where\nbind = \"tcp://127.0.0.1:5612\"\n");
    PairedFiles files(file);
    const CurveKeys keys = files.own_keys();
    EXPECT_EQ(files.own_keys().public_key, keys.public_key) << "made once";
    const PairReveal gallery = host("gallery");
    EXPECT_EQ(files.admit(gallery, true).size(), 3u);
    const RigConfig config = load_rig_config(file);
    EXPECT_EQ(config.stream.bind, "tcp://*:5612");
    EXPECT_EQ(config.stream.key_file, folder.path() / "rig.key");
    EXPECT_EQ(load_authorized_hosts(config.stream.authorized_hosts).at(gallery.public_key),
              "gallery");
    EXPECT_NE(read_text_file(file, 4096).find("# mine"), std::string::npos);
}

TEST_F(PairedFilesTest, AddsAHostToAListAndLeavesTheRest) {
    const PairReveal first = host("first"), second = host("second");
    write_text_atomically(folder.path() / "h", "# mine\n" + first.public_key + " first");
    write("[stream]\nbind = \"tcp://*:5600\"\nkey_file = \"k\"\nauthorized_hosts = \"h\"\n");
    const std::string before = read_text_file(file, 4096);
    PairedFiles files(file);
    files.own_keys();
    EXPECT_TRUE(files.admit(second, true).empty());
    EXPECT_TRUE(files.admit(second, true).empty()) << "a second time";
    EXPECT_EQ(read_text_file(file, 4096), before);
    EXPECT_EQ(read_text_file(folder.path() / "h", 4096),
              "# mine\n" + first.public_key + " first\n" + second.public_key + " second\n");
}

TEST_F(PairedFilesTest, KeepsALoopbackStreamAfterPairingOnOneComputer) {
    write("");
    PairedFiles files(file);
    files.own_keys();
    EXPECT_EQ(files.admit(host("gallery"), false).size(), 2u);
    EXPECT_EQ(load_rig_config(file).stream.bind, RigConfig::Stream().bind);
}

}  // namespace
}  // namespace vantage
