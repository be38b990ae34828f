/// sinew-fake-portal FILE...: a desktop whose file dialog chooses these files by itself, one with each call, in turn;
/// on the bus of the environment, until it is ended.

#include <unistd.h>

#include <cstdio>

#include "tests/apps/fake_portal.h"

int main(int argc, char** argv) {
  std::vector<std::string> uris;
  for (int i = 1; i < argc; ++i) {
    std::string uri = "file://";
    for (const char* c = argv[i]; *c != 0; ++c) uri += *c == ' ' ? "%20" : std::string(1, *c);
    uris.push_back(std::move(uri));
  }
  const sinew::editor::FakePortal portal(sinew::editor::FakePortal::Manner::InTurn, uris);
  if (!portal.ready()) return 1;
  std::puts("ready");
  std::fflush(stdout);
  for (;;) pause();
}
