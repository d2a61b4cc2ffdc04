#include "common/base/files/atomic_file.h"

#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "tests/support/data_folder.h"
#include "tests/support/thrown_sentence.h"

namespace vantage {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) {
    return std::as_bytes(std::span(text));
}

std::string text_in(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::ptrdiff_t files_in(const std::filesystem::path& folder) {
    return std::distance(std::filesystem::directory_iterator(folder), {});
}

TEST(AtomicFile, ReplacesAFileAndLeavesNothingBeside) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.txt";
    write_file_atomically(path, bytes_of("first, and longer"));
    write_file_atomically(path, bytes_of("second"));
    EXPECT_EQ(text_in(path), "second");
    EXPECT_EQ(files_in(folder.path()), 1);
    write_file_atomically(path, {});
    EXPECT_EQ(text_in(path), "");
}

TEST(AtomicFile, LeavesTheOldFileWhenTheDiskIsFull) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.bin";
    write_file_atomically(path, bytes_of("the old one"));
    // A file size limit fails in the middle of writing, as a full disk does.
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    rlimit small = before;
    small.rlim_cur = 4096;
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string message =
        thrown_sentence([&] { write_file_atomically(path, bytes_of(std::string(100000, 'x'))); });
    ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
    std::signal(SIGXFSZ, handler);
    EXPECT_NE(message.find(path.string()), std::string::npos) << message;
    EXPECT_NE(message.find("File too large"), std::string::npos) << message;
    EXPECT_EQ(text_in(path), "the old one");
    EXPECT_EQ(files_in(folder.path()), 1) << "no half-written file stays";
}

TEST(AtomicFile, NamesThePathAndTheReason) {
    const TemporaryFolder folder;
    EXPECT_EQ(
        thrown_sentence([&] { write_file_atomically(folder.path() / "no" / "a", bytes_of("x")); }),
        "cannot write " + (folder.path() / "no" / "a").string() + ": No such file or directory");
    EXPECT_NE(thrown_sentence([&] { write_file_atomically(folder.path(), bytes_of("x")); }), "");
    EXPECT_EQ(files_in(folder.path()), 0);
}

TEST(AtomicFile, ConcurrentWritersLeaveOneCompleteFile) {
    const TemporaryFolder folder;
    const auto path = folder.path() / "a.bin";
    const auto write = [&](char letter) {
        for (int i = 0; i < 20; ++i)
            write_file_atomically(path, bytes_of(std::string(50000, letter)));
    };
    std::thread other(write, 'a');
    write('b');
    other.join();
    const std::string text = text_in(path);
    EXPECT_TRUE(text == std::string(50000, 'a') || text == std::string(50000, 'b'));
    EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(AtomicFile, HonoursTheUmask) {
    const TemporaryFolder folder;
    const mode_t before = umask(0027);
    write_file_atomically(folder.path() / "a", bytes_of("x"));
    umask(before);
    struct stat status {};
    ASSERT_EQ(stat((folder.path() / "a").c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST(ReadFile, GivesBackWhatWasWritten) {
    const TemporaryFolder folder;
    const std::string text("with\0 a zero", 12);
    write_file_atomically(folder.path() / "a", bytes_of(text));
    const auto bytes = read_file(folder.path() / "a", 12);
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()), text);
}

TEST(ReadFile, RefusesMissingAndTooLargeFilesAndFolders) {
    const TemporaryFolder folder;
    write_file_atomically(folder.path() / "a", bytes_of("12345"));
    EXPECT_NE(thrown_sentence([&] { read_file(folder.path() / "a", 4); }).find("5 bytes"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] { read_file(folder.path() / "b", 4); }).find("No such file"),
              std::string::npos);
    EXPECT_NE(thrown_sentence([&] { read_file(folder.path(), 4); }).find("is a folder"),
              std::string::npos);
}

}  // namespace
}  // namespace vantage
