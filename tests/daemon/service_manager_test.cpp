#include "daemon/service_manager.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

#include "support/temporary_folder.hpp"

namespace gfp {
namespace {

/// What systemd does: a datagram socket whose name is in NOTIFY_SOCKET. `name` begins with @ where it is abstract.
class Manager {
 public:
  explicit Manager(const std::string& name) : file_(socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    name.copy(address.sun_path, name.size());
    if (name[0] == '@') address.sun_path[0] = '\0';
    EXPECT_EQ(bind(file_, reinterpret_cast<const sockaddr*>(&address), static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size())), 0);
    setenv("NOTIFY_SOCKET", name.c_str(), 1);
  }
  ~Manager() {
    unsetenv("NOTIFY_SOCKET");
    close(file_);
  }
  std::string heard() const {
    char text[256];
    const auto size = recv(file_, text, sizeof text, 0);
    return size < 0 ? "" : std::string(text, static_cast<std::size_t>(size));
  }

 private:
  const int file_;
};

TEST(ServiceManager, HearsEachStateOnItsSocket) {
  const test::TemporaryFolder folder;
  const Manager manager((folder / "notify").string());
  tell_service_manager("READY=1");
  tell_service_manager("WATCHDOG=1");
  EXPECT_EQ(manager.heard(), "READY=1");
  EXPECT_EQ(manager.heard(), "WATCHDOG=1");
  tell_reloading();
  EXPECT_EQ(manager.heard().rfind("RELOADING=1\nMONOTONIC_USEC=", 0), 0U);
}

TEST(ServiceManager, MayHaveAnAbstractSocket) {
  const Manager manager("@gfp-service-manager-test-" + std::to_string(getpid()));
  tell_service_manager("STOPPING=1");
  EXPECT_EQ(manager.heard(), "STOPPING=1");
}

TEST(ServiceManager, MayBeAbsentGoneOrNonsense) {
  unsetenv("NOTIFY_SOCKET");
  tell_service_manager("READY=1");
  for (const std::string& name : {std::string("/no/such/socket"), std::string(4096, 'x'), std::string()}) {
    setenv("NOTIFY_SOCKET", name.c_str(), 1);
    tell_service_manager("READY=1");
  }
  unsetenv("NOTIFY_SOCKET");
}

}  // namespace
}  // namespace gfp
