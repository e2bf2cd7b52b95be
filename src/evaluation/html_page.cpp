#include "html_page.hpp"

#include <fstream>

namespace gfp {
namespace {

constexpr const char* kStyle =
    "body{font:14px sans-serif;margin:1.5em;background:#fcfcfa;color:#222}pre{font-size:12px;overflow-x:auto}"
    "figure{margin:0 0 .8em;border-top:1px solid #ddd;padding-top:.4em}figcaption{font-size:12px;white-space:pre}"
    "img{display:block;max-width:100%}h2{margin-top:1.5em}b.bad{color:#b00}b.good{color:#070}button{margin-right:.5em}"
    ".row{display:flex;flex-wrap:wrap;gap:.6em}.row figure{border:0;width:300px}.row figcaption{white-space:pre-wrap}";

}  // namespace

std::string page_start(const std::string& title, const std::string& script) {
  std::string html = "<!doctype html><meta charset=utf-8><title>" + escaped(title) + "</title><style>" + kStyle + "</style>";
  if (!script.empty()) html += "<script>" + script + "</script>";
  return html + "<h1>" + escaped(title) + "</h1>";
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<') result += "&lt;";
    else if (c == '>') result += "&gt;";
    else if (c == '&') result += "&amp;";
    else if (c == '"') result += "&quot;";
    else result += c;
  }
  return result;
}

Result<void> write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream out(path, std::ios::binary);
  out.write(text.data(), static_cast<std::streamsize>(text.size()));
  if (!out.flush()) return failure(ErrorCode::kIo, path.string() + ": cannot be written");
  return {};
}

}  // namespace gfp
