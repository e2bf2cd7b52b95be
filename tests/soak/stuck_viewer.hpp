#pragma once

#include <memory>

namespace gfp::test {

/// A viewer that subscribes to everything that the view offers and then never reads again.
class StuckViewer {
 public:
  explicit StuckViewer(int port);
  ~StuckViewer();

 private:
  struct Connection;
  std::unique_ptr<Connection> connection_;
};

}  // namespace gfp::test
