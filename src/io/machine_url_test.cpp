#include "io/machine_url.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

namespace kerf::io {
namespace {

MachineUrl virtual_machine(std::string_view key, Speed speed) {
  return VirtualAddress{.personality = firmware::personality_named(key), .speed = speed};
}

MachineUrl parsed(std::string_view text) {
  auto url = parse_machine_url(text);
  EXPECT_TRUE(url.has_value()) << text << ": " << explain(url.error());
  return url.value_or(MachineUrl{});
}

UrlFault fault_of(std::string_view text) {
  auto url = parse_machine_url(text);
  EXPECT_FALSE(url.has_value()) << text << " became " << to_string(*url);
  return url ? UrlFault{} : url.error().fault;
}

TEST(MachineUrl, FullForms) {
  EXPECT_EQ(parsed("serial:///dev/ttyUSB0?baud=250000"), MachineUrl(SerialAddress{"/dev/ttyUSB0", 250000}));
  EXPECT_EQ(parsed("serial:///dev/ttyACM0"), MachineUrl(SerialAddress{"/dev/ttyACM0", 115200}));
  EXPECT_EQ(parsed("serial://COM3?baud=9600"), MachineUrl(SerialAddress{"COM3", 9600}));
  EXPECT_EQ(parsed("tcp://rabbit.local:5001"), MachineUrl(TcpAddress{"rabbit.local", 5001}));
  EXPECT_EQ(parsed("tcp://127.0.0.1:23/"), MachineUrl(TcpAddress{"127.0.0.1", 23}));
  EXPECT_EQ(parsed("tcp://[::1]:23"), MachineUrl(TcpAddress{"::1", 23}));
  EXPECT_EQ(parsed("pty:///tmp/kerf-grblhal"), MachineUrl(PtyAddress{"/tmp/kerf-grblhal"}));
  EXPECT_EQ(parsed("virtual:grblhal?speed=max"), (virtual_machine("grblhal", Speed{std::nullopt})));
  EXPECT_EQ(parsed("virtual:grblhal-expr"), virtual_machine("grblhal-expr", Speed{1.0}));
  EXPECT_EQ(parsed("virtual:grbl"), (virtual_machine("grbl", Speed{1.0})));
  EXPECT_EQ(parsed("virtual://rabbit?speed=2.5"), (virtual_machine("rabbit", Speed{2.5})));
}

TEST(MachineUrl, Shorthands) {
  EXPECT_EQ(parsed("/dev/ttyUSB0"), MachineUrl(SerialAddress{"/dev/ttyUSB0", 115200}));
  EXPECT_EQ(parsed("/dev/ttyUSB0?baud=57600"), MachineUrl(SerialAddress{"/dev/ttyUSB0", 57600}));
  EXPECT_EQ(parsed("COM3"), MachineUrl(SerialAddress{"COM3", 115200}));
  EXPECT_EQ(parsed("/dev/pts/4"), MachineUrl(PtyAddress{"/dev/pts/4"}));
  EXPECT_EQ(parsed("/tmp/kerf-grbl"), MachineUrl(PtyAddress{"/tmp/kerf-grbl"}));
  EXPECT_EQ(parsed("192.168.4.1:5001"), MachineUrl(TcpAddress{"192.168.4.1", 5001}));
  EXPECT_EQ(parsed("[fe80::1]:23"), MachineUrl(TcpAddress{"fe80::1", 23}));
  EXPECT_EQ(parsed("virtual:23"), MachineUrl(TcpAddress{"virtual", 23}));  // a host may have any name
  EXPECT_EQ(parsed("virtual"), MachineUrl(VirtualAddress{}));
  EXPECT_EQ(parsed("VIRTUAL:Rabbit"), (virtual_machine("rabbit", Speed{1.0})));
}

TEST(MachineUrl, EveryFaultIsNamed) {
  EXPECT_EQ(fault_of(""), UrlFault::Empty);
  EXPECT_EQ(fault_of("http://host:81"), UrlFault::UnknownScheme);
  EXPECT_EQ(fault_of("tcp://:5001"), UrlFault::NoHost);
  EXPECT_EQ(fault_of("rabbit.local"), UrlFault::NoPort);
  EXPECT_EQ(fault_of("tcp://rabbit.local"), UrlFault::NoPort);
  EXPECT_EQ(fault_of("host:0"), UrlFault::BadPort);
  EXPECT_EQ(fault_of("host:65536"), UrlFault::BadPort);
  EXPECT_EQ(fault_of("host:http"), UrlFault::BadPort);
  EXPECT_EQ(fault_of("fe80::1:23"), UrlFault::NotAnAddress);
  EXPECT_EQ(fault_of("[::1"), UrlFault::NotAnAddress);
  EXPECT_EQ(fault_of("serial://"), UrlFault::NoPath);
  EXPECT_EQ(fault_of("pty://kerf-grbl"), UrlFault::RelativePath);
  EXPECT_EQ(fault_of("/dev/ttyUSB0?baud=fast"), UrlFault::BadBaud);
  EXPECT_EQ(fault_of("/dev/ttyUSB0?baud=1"), UrlFault::BadBaud);
  EXPECT_EQ(fault_of("/dev/ttyUSB0?parity=even"), UrlFault::UnknownOption);
  EXPECT_EQ(fault_of("virtual:smoothie"), UrlFault::UnknownPersonality);
  EXPECT_EQ(fault_of("virtual:grbl?speed=warp"), UrlFault::BadSpeed);
  EXPECT_EQ(fault_of("virtual:grbl?speed=0"), UrlFault::BadSpeed);
  EXPECT_EQ(fault_of("my machine:23"), UrlFault::NotAnAddress);
}

TEST(MachineUrl, FaultsSayWhatToWrite) {
  const auto no_port = parse_machine_url("rabbit.local");
  ASSERT_FALSE(no_port);
  EXPECT_NE(explain(no_port.error()).find("rabbit.local:PORT"), std::string::npos);
  const auto personality = parse_machine_url("virtual:marlin");
  ASSERT_FALSE(personality);
  EXPECT_EQ(explain(personality.error()),
            "There is no virtual machine 'marlin': choose grbl, rabbit, grblhal or grblhal-expr.");
}

TEST(MachineUrl, WebSockets) {
  EXPECT_EQ(parsed("ws://192.168.5.1:81"), MachineUrl(WebSocketAddress{"192.168.5.1", 81}));
  EXPECT_EQ(parsed("WS://[::1]:80/ws"), MachineUrl(WebSocketAddress{"::1", 80, "/ws"}));
  EXPECT_EQ(parsed("ws://h:81/?protocol=none"), MachineUrl(WebSocketAddress{"h", 81, "/", ""}));
  EXPECT_EQ(parsed("ws://h:81?protocol=webui-v3"), MachineUrl(WebSocketAddress{"h", 81, "/", "webui-v3"}));
  EXPECT_EQ(fault_of("ws://fluidnc.local"), UrlFault::NoWebSocketPort);
  EXPECT_EQ(fault_of("ws://:81/"), UrlFault::NoHost);
  EXPECT_EQ(fault_of("ws://h:81/a b"), UrlFault::NotAnAddress);
  EXPECT_EQ(fault_of("ws://h:81/?protocol=a,b"), UrlFault::BadProtocol);
  EXPECT_EQ(fault_of("ws://h:81/?frames=text"), UrlFault::UnknownOption);
}

TEST(ServeUrl, TcpOrWebSocket) {
  EXPECT_EQ(parse_serve_url("ws://127.0.0.1:0"), (ServeAddress{{"127.0.0.1", 0}, true}));
  EXPECT_EQ(parse_serve_url("127.0.0.1:5001"), (ServeAddress{{"127.0.0.1", 5001}, false}));
}

TEST(ListenUrl, TakesPortZeroAndNothingButTcp) {
  EXPECT_EQ(parse_listen_url("tcp://127.0.0.1:0"), (TcpAddress{"127.0.0.1", 0}));
  EXPECT_EQ(parse_listen_url("0.0.0.0:5001"), (TcpAddress{"0.0.0.0", 5001}));
  EXPECT_EQ(parse_listen_url("pty:///tmp/x").error().fault, UrlFault::UnknownScheme);
  EXPECT_EQ(parse_listen_url("127.0.0.1").error().fault, UrlFault::NoPort);
}

RC_GTEST_PROP(MachineUrlProperty, PrintedAddressIsReadBack, ()) {
  const auto name = *rc::gen::nonEmpty(rc::gen::container<std::string>(rc::gen::inRange('a', 'z')));
  const auto port = *rc::gen::inRange<std::uint16_t>(1, 65535);
  const auto baud = *rc::gen::inRange(300, 4'000'000);
  for (const MachineUrl& url :
       {MachineUrl(SerialAddress{"/dev/" + name, baud}), MachineUrl(TcpAddress{name, port}),
        MachineUrl(PtyAddress{"/" + name}), MachineUrl(WebSocketAddress{name, port, "/" + name}),
        MachineUrl(WebSocketAddress{name, port, "/", name})}) {
    const bool is_read_back = parse_machine_url(to_string(url)) == url;
    RC_ASSERT(is_read_back);
  }
}

RC_GTEST_PROP(MachineUrlProperty, AnyTextIsAnsweredWithAValueOrASentence, (const std::string& text)) {
  const auto url = parse_machine_url(text);
  if (!url) RC_ASSERT(!explain(url.error()).empty());
}

}  // namespace
}  // namespace kerf::io
