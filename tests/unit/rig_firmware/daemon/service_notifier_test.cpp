#include "rig_firmware/daemon/service_notifier.h"

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>

#include "common/base/files/unique_fd.h"
#include "tests/support/data_folder.h"

namespace vantage {
namespace {

/// A service manager's socket.
class ServiceNotifierTest : public testing::Test {
  protected:
    ServiceNotifierTest() : fd_(::socket(AF_UNIX, SOCK_DGRAM, 0)) {
        const std::string path = (folder_.path() / "notify").string();
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
        EXPECT_EQ(::bind(fd_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
        ::setenv("NOTIFY_SOCKET", path.c_str(), 1);
    }
    ~ServiceNotifierTest() override {
        ::unsetenv("NOTIFY_SOCKET");
        ::unsetenv("WATCHDOG_USEC");
    }
    std::string heard() const {
        std::array<char, 200> text{};
        const ssize_t size = ::recv(fd_.get(), text.data(), text.size(), MSG_DONTWAIT);
        return size < 0 ? "" : std::string(text.data(), static_cast<std::size_t>(size));
    }

    TemporaryFolder folder_;
    UniqueFd fd_;
};

TEST_F(ServiceNotifierTest, SaysThatItStandsAndStops) {
    ServiceNotifier notifier;
    notifier.ready();
    EXPECT_EQ(heard(), "READY=1");
    notifier.stopping();
    EXPECT_EQ(heard(), "STOPPING=1");
}

TEST_F(ServiceNotifierTest, GivesASignOfLifeEveryHalfOfTheWatchdogsTime) {
    ::setenv("WATCHDOG_USEC", "3600000000", 1);
    ServiceNotifier seldom;
    seldom.alive("30.0 frames/s");
    EXPECT_EQ(heard(), "WATCHDOG=1\nSTATUS=30.0 frames/s");
    seldom.alive("30.0 frames/s");
    EXPECT_EQ(heard(), "") << "half an hour has not passed";
    ::setenv("WATCHDOG_USEC", "1", 1);
    ServiceNotifier often;
    often.alive("a");
    often.alive("b");
    EXPECT_EQ(heard(), "WATCHDOG=1\nSTATUS=a");
    EXPECT_EQ(heard(), "WATCHDOG=1\nSTATUS=b");
}

TEST_F(ServiceNotifierTest, GivesNoSignOfLifeWhileAPartIsStuck) {
    ::setenv("WATCHDOG_USEC", "1", 1);
    ServiceNotifier notifier;
    notifier.stuck("the thread 'gpu' is stuck");
    EXPECT_EQ(heard(), "STATUS=the thread 'gpu' is stuck");
    notifier.alive("30.0 frames/s");
    EXPECT_EQ(heard(), "WATCHDOG=1\nSTATUS=30.0 frames/s");
}

TEST_F(ServiceNotifierTest, DoesNothingWithoutAServiceManager) {
    ::unsetenv("NOTIFY_SOCKET");
    ServiceNotifier notifier;
    notifier.ready();
    notifier.alive("a");
    EXPECT_EQ(heard(), "");
}

}  // namespace
}  // namespace vantage
