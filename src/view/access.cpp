#include "view/access.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace gfp::view {
namespace {

constexpr std::size_t kMinTokenLength = 16;

/// Takes as long for a wrong token as for the right one.
bool equal_secrets(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]);
  return difference == 0;
}

/// The value of `name=value` in a list with separators; empty where it is not in it.
std::string_view value_in(std::string_view list, std::string_view name, char separator) {
  while (!list.empty()) {
    const std::size_t end = list.find(separator);
    std::string_view item = list.substr(0, end);
    while (item.starts_with(' ')) item.remove_prefix(1);
    if (item.starts_with(name) && item.substr(name.size()).starts_with('=')) return item.substr(name.size() + 1);
    list = end == std::string_view::npos ? std::string_view() : list.substr(end + 1);
  }
  return {};
}

std::string_view without_port(std::string_view host) {
  if (host.starts_with('[')) return host.substr(1, host.find(']') == std::string_view::npos ? 0 : host.find(']') - 1);
  return host.substr(0, host.rfind(':'));
}

}  // namespace

bool is_loopback(std::string_view address) { return address == "localhost" || address == "::1" || address.starts_with("127."); }

Result<void> validate(const ViewOptions& options) {
  if (!options.token.empty() && options.token.size() < kMinTokenLength)
    return failure(ErrorCode::kInvalidArgument, fmt::format("view.token has {} characters, expected at least {}", options.token.size(), kMinTokenLength));
  if (!is_loopback(options.address) && options.token.empty())
    return failure(ErrorCode::kInvalidArgument, fmt::format("view.address = {}, expected 127.0.0.1 (others would see everything: give view.token)", options.address));
  return {};
}

bool has_token(const Caller& caller, const ViewOptions& options) {
  if (options.token.empty()) return true;
  const std::size_t query = caller.target.find('?');
  if (query != std::string_view::npos && equal_secrets(value_in(caller.target.substr(query + 1), "token", '&'), options.token)) return true;
  constexpr std::string_view kBearer = "Bearer ";
  if (caller.authorization.starts_with(kBearer) && equal_secrets(caller.authorization.substr(kBearer.size()), options.token)) return true;
  return equal_secrets(value_in(caller.cookie, kCookieName, ';'), options.token);
}

bool is_welcome_origin(const Caller& caller, const ViewOptions& options) {
  if (caller.origin.empty()) return true;  // no page: a program, which could say anything
  if (caller.origin == fmt::format("http://{}", caller.host) || caller.origin == fmt::format("https://{}", caller.host)) return true;
  return std::find(options.allowed_origins.begin(), options.allowed_origins.end(), caller.origin) != options.allowed_origins.end();
}

bool is_our_host(const Caller& caller, const ViewOptions& options) { return !is_loopback(options.address) || is_loopback(without_port(caller.host)); }

}  // namespace gfp::view
