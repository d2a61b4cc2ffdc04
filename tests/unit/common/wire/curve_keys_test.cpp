#include "common/wire/curve_keys.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/error.h"
#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

using testing::HasSubstr;

class CurveKeysTest : public testing::Test {
  protected:
    std::filesystem::path write(const std::string& name, const std::string& text,
                                mode_t mode = S_IRUSR | S_IWUSR) const {
        const std::filesystem::path path = folder_.path() / name;
        std::ofstream(path) << text;
        ::chmod(path.c_str(), mode);
        return path;
    }

    static std::string refusal_of_key_file(const std::filesystem::path& path) {
        return thrown_sentence([&] { load_key_file(path); });
    }

    static std::string key_file_text(const std::string& public_key, const std::string& secret_key) {
        return fmt::format("version = 1\npublic = \"{}\"\nsecret = \"{}\"\n", public_key,
                           secret_key);
    }

    TemporaryFolder folder_;
};

TEST_F(CurveKeysTest, RoundTripsAFileThatOnlyItsOwnerCanRead) {
    const std::filesystem::path path = folder_.path() / "rig.key";
    const CurveKeys made = generate_curve_keys();
    write_key_file(path, made);
    const CurveKeys loaded = load_key_file(path);
    EXPECT_EQ(loaded.public_key, made.public_key);
    EXPECT_EQ(loaded.secret_key, made.secret_key);
    struct stat facts {};
    ASSERT_EQ(::stat(path.c_str(), &facts), 0);
    EXPECT_EQ(facts.st_mode & 0777, mode_t{0600});
}

TEST_F(CurveKeysTest, NoTwoPairsAreAlike) {
    EXPECT_NE(generate_curve_keys().secret_key, generate_curve_keys().secret_key);
}

TEST_F(CurveKeysTest, AnExistingFileIsLeftAsItIs) {
    const std::filesystem::path path = write("rig.key", "mine");
    EXPECT_THROW(write_key_file(path, generate_curve_keys()), Error);
    std::ifstream in(path);
    EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), "mine");
}

TEST_F(CurveKeysTest, BadKeyFilesAreRefusedWithTheMend) {
    const CurveKeys keys = generate_curve_keys();
    const std::string good = key_file_text(keys.public_key, keys.secret_key);
    EXPECT_EQ(refusal_of_key_file(write("good", good)), "");
    EXPECT_THAT(refusal_of_key_file(write("open", good, 0644)), HasSubstr("chmod o= "));
    EXPECT_THAT(refusal_of_key_file(folder_.path() / "missing"), HasSubstr("missing"));
    EXPECT_THAT(refusal_of_key_file(write("damaged", "version = \n")), HasSubstr("line 1"));
    EXPECT_THAT(refusal_of_key_file(write("empty", "")), HasSubstr("version"));
    EXPECT_THAT(refusal_of_key_file(write("fraction", "version = 1.0\n")), HasSubstr("version"));
    EXPECT_THAT(refusal_of_key_file(write("half", "version = 1\npublic = \"x\"\n")),
                HasSubstr("public key"));
    EXPECT_THAT(
        refusal_of_key_file(write("no_secret", key_file_text(keys.public_key, "too short"))),
        HasSubstr("secret key"));
    EXPECT_THAT(refusal_of_key_file(write(
                    "mixed", key_file_text(generate_curve_keys().public_key, keys.secret_key))),
                HasSubstr("do not belong together"));
    EXPECT_THAT(refusal_of_key_file(write("large", std::string(70000, '#'))), HasSubstr("limit"));
    EXPECT_THAT(refusal_of_key_file(folder_.path()), HasSubstr("folder"));
}

TEST_F(CurveKeysTest, OnlyItsGroupMayAlsoReadAKeyFile) {
    const CurveKeys keys = generate_curve_keys();
    const std::string good = key_file_text(keys.public_key, keys.secret_key);
    EXPECT_EQ(refusal_of_key_file(write("owner", good, 0600)), "");
    EXPECT_EQ(refusal_of_key_file(write("owner_only_reads", good, 0400)), "");
    EXPECT_EQ(refusal_of_key_file(write("group", good, 0640)), "");
    EXPECT_THAT(refusal_of_key_file(write("group_writes", good, 0660)), HasSubstr("chmod g=r "));
    EXPECT_THAT(refusal_of_key_file(write("all", good, 0644)), HasSubstr("mode 644"));
    EXPECT_THAT(refusal_of_key_file(write("others_only", good, 0604)), HasSubstr("chmod o= "));
}

TEST_F(CurveKeysTest, RefusesAKeyFileOfAnotherUser) {
    if (::geteuid() != 0) GTEST_SKIP() << "SKIPPED: only root gives files away";
    const CurveKeys keys = generate_curve_keys();
    const std::filesystem::path path =
        write("rig.key", key_file_text(keys.public_key, keys.secret_key), 0640);
    ASSERT_EQ(::chown(path.c_str(), 54321, 0), 0);
    EXPECT_THAT(refusal_of_key_file(path), HasSubstr("belongs to user 54321"));
    ASSERT_EQ(::chown(path.c_str(), 0, 54321), 0);
    EXPECT_THAT(refusal_of_key_file(path), HasSubstr("can be read by group 54321"));
    ::chmod(path.c_str(), 0600);
    EXPECT_EQ(refusal_of_key_file(path), "");
}

TEST(KeyFileFault, AcceptsRootTheReaderAndTheServicesGroup) {
    constexpr uid_t service = 990, somebody = 1000;
    constexpr gid_t its_group = 991, users = 100;
    const KeyFileReader reader{.users = {0, service}, .groups = {its_group}};
    for (const uid_t owner : {uid_t{0}, service})
        for (const mode_t mode : {0400, 0600, 0440, 0640}) {
            EXPECT_EQ(key_file_fault({owner, its_group, mode}, reader), "") << owner << ' ' << mode;
            EXPECT_NE(key_file_fault({somebody, its_group, mode}, reader), "") << mode;
        }
    EXPECT_EQ(key_file_fault({0, users, 0600}, reader), "");
    EXPECT_NE(key_file_fault({0, users, 0640}, reader), "");
    for (const mode_t mode : {0660, 0650, 0644, 0604, 0601, 0666, 0777})
        EXPECT_NE(key_file_fault({service, its_group, mode}, reader), "") << mode;
}

TEST_F(CurveKeysTest, KeysAreFortyCharactersOfZ85) {
    EXPECT_TRUE(is_curve_key(generate_curve_keys().public_key));
    EXPECT_FALSE(is_curve_key(""));
    EXPECT_FALSE(is_curve_key(std::string(39, 'a')));
    EXPECT_FALSE(is_curve_key(std::string(39, 'a') + '\"'));
    EXPECT_FALSE(is_curve_key(std::string(39, 'a') + '\xff'));
    // Five characters that begin with '#' stand for more than 32 bits, so a comment is no key.
    EXPECT_TRUE(is_curve_key("0" + std::string(39, '0')));
    EXPECT_FALSE(is_curve_key("#" + std::string(39, '0')));
}

TEST_F(CurveKeysTest, TheListOfHostsTakesNamesCommentsAndEmptyLines) {
    const std::string a = generate_curve_keys().public_key;
    const std::string b = generate_curve_keys().public_key;
    const auto hosts =
        load_authorized_hosts(write("hosts", "# the hosts\n\n#no blank after the mark\n" + a +
                                                 "  gallery, main host\n" + "  " + b + "\r\n"));
    EXPECT_THAT(hosts, testing::UnorderedElementsAre(testing::Key(b),
                                                     testing::Pair(a, "gallery, main host")));
}

TEST_F(CurveKeysTest, NamesAnInvalidLine) {
    const std::filesystem::path list = write("hosts", "# fine\nkey-of-the-gallery\n");
    EXPECT_THAT(thrown_sentence([&] { load_authorized_hosts(list); }), HasSubstr("line 2"));
}

}  // namespace
}  // namespace vantage
