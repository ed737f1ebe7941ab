#include "app/view/web/web_page.h"

#include "app/view/web/http.h"
#include "app/view/web/web_guard.h"

namespace neve::app::view::web {
namespace {

std::string fill_in(std::string_view page, const std::string& number) {
  std::string text(page);
  constexpr std::string_view mark = "{{nonce}}";
  for (std::size_t k = 0; (k = text.find(mark, k)) != std::string::npos; k += number.size())
    text.replace(k, mark.size(), number);
  return text;
}

std::string answer_with(int status, std::string_view file, const std::string& may_connect) {
  const std::string nonce = make_token();
  const std::string policy = "default-src 'none'; script-src 'nonce-" + nonce +
                             "'; style-src 'nonce-" + nonce + "'; connect-src " + may_connect +
                             "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
  return http_answer(status, "text/html; charset=utf-8", fill_in(find_embedded_page(file), nonce),
                     {{"Content-Security-Policy", policy}});
}

}  // namespace

std::string page_answer(const std::string& sockets) {
  return answer_with(200, "web_page.html", sockets);
}

std::string no_token_answer() {
  return answer_with(403, "web_no_token.html", "'none'");
}

}  // namespace neve::app::view::web
