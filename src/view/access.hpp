#pragma once

#include <string>
#include <string_view>

#include "gfp/core/error.hpp"
#include "view/view_options.hpp"

namespace gfp::view {

/// What an HTTP request says of who sends it.
struct Caller {
  std::string_view target;         ///< As in `/?token=...`.
  std::string_view host;           ///< Header Host.
  std::string_view origin;         ///< Header Origin; empty where no page sends it.
  std::string_view authorization;  ///< Header Authorization.
  std::string_view cookie;         ///< Header Cookie.
};

bool is_loopback(std::string_view address);  ///< 127.x.y.z, ::1 or localhost.

/// Beyond loopback a token is needed, and it has at least 16 characters. Errors: kInvalidArgument.
Result<void> validate(const ViewOptions& options);

/// Whether the token, where one is set, was given.
bool has_token(const Caller& caller, const ViewOptions& options);

/// Whether the page that connects (if it is one) is ours or an allowed one: a browser lets any page open a WebSocket to this host.
bool is_welcome_origin(const Caller& caller, const ViewOptions& options);

/// Whether the request means this host: where the view is bound to loopback, another name is a page that had its own name resolve to us.
bool is_our_host(const Caller& caller, const ViewOptions& options);

inline constexpr std::string_view kCookieName = "gfp_view_token";

}  // namespace gfp::view
