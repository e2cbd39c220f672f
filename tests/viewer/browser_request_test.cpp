#include <string>

#include <gtest/gtest.h>

#include "viewer/browser_request.h"
#include "viewer/web_socket.h"

namespace relief::viewer {
namespace {

TEST(BrowserRequest, is_taken_apart) {
    const std::optional<BrowserRequest> request =
        parse_request("GET /picture?token=ab&after=7&x HTTP/1.1\r\nHost:  localhost:80 \r\nX-Other: a:b");
    ASSERT_TRUE(request);
    EXPECT_EQ(request->method, "GET");
    EXPECT_EQ(request->path, "/picture");
    EXPECT_EQ(request->variable("token"), "ab");
    EXPECT_EQ(request->variable("after"), "7");
    EXPECT_EQ(request->variable("x"), "");
    EXPECT_EQ(request->header("host"), "localhost:80");
    EXPECT_EQ(request->header("x-other"), "a:b");
    EXPECT_FALSE(refuse_request(*request, "ab"));
    EXPECT_EQ(refuse_request(*request, "abc").value().status, 403);
}

TEST(BrowserRequest, is_refused_where_it_is_none) {
    for (const char* text :
         {"", "GET", "GET /", "GET http://x/ HTTP/1.1", "GET / FTP/1.0", "GET / HTTP/1.1\r\nx",
          "GET / HTTP/1.1\r\nHost: a\r\nhost: b", "GET / HTTP/1.1\r\nOrigin: a\r\nOrigin: a"})
        EXPECT_FALSE(parse_request(text)) << text;
}

TEST(WebSocket, answers_the_key_of_the_protocol) {
    EXPECT_EQ(make_accept_key("dGhlIHNhbXBsZSBub25jZQ=="),
              "s3pPLMBiTxaQ9kYGzzhZRbK+xOo="); // RFC 6455, section 1.3
}

TEST(WebSocket, reads_a_masked_frame_and_refuses_others) {
    // RFC 6455, section 5.7: "Hello", masked.
    const std::string hello = "\x81\x85\x37\xfa\x21\x3d\x7f\x9f\x4d\x51\x58";
    SocketFrame frame;
    ASSERT_EQ(read_frame(hello + "more", frame), FrameFault::none);
    EXPECT_EQ(frame.content, "Hello");
    EXPECT_EQ(frame.bytes, hello.size());
    EXPECT_TRUE(frame.is_last);
    for (size_t size = 0; size < hello.size(); ++size)
        EXPECT_EQ(read_frame(hello.substr(0, size), frame), FrameFault::incomplete) << size;
    EXPECT_EQ(read_frame("\x81\x05Hello", frame), FrameFault::refused) << "not masked";
    EXPECT_EQ(read_frame(std::string("\x81\xff\0\0\0\0\0\1\0\1....", 14), frame), FrameFault::refused)
        << "too long";
}

} // namespace
} // namespace relief::viewer
