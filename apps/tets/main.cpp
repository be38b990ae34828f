/// sinew-tets: fills a closed surface with tets by TetGen, in a process of its own, because TetGen ends its process on
/// some surfaces, and takes any time and memory on others. Reads and writes as deformers/tet_protocol.h says.

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <tetgen.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include "deformers/tet_protocol.h"

namespace {

using namespace sinew::tets;

// TetGen's switches: p surface, Y keep it as it is, A number regions, q1.414 better tets by vertices inside, d only
// look for crossings, Q quiet. T: what is one plane; its own 1e-8 takes bent faces for flat ones, and then turns tets
// inside out.
constexpr const char* fill = "pYAT1e-12Q";
constexpr const char* fill_inside = "pq1.414YAT1e-12Q";
constexpr const char* look_for_crossings = "pdT1e-12Q";

/// Two descriptors: the reply's, and what TetGen prints goes nowhere.
int take_standard_output() {
  const int reply = fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3);
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  return reply;
}

void set_limit(__rlimit_resource what, rlim_t value) {
  rlimit limit{};
  getrlimit(what, &limit);
  limit.rlim_cur = std::min(value, limit.rlim_max);  // past the hard one, time ends a process without SIGXCPU
  setrlimit(what, &limit);
}

bool number(std::string_view text, std::uint64_t& value) {
  return std::from_chars(text.data(), text.data() + text.size(), value).ptr == text.data() + text.size();
}

std::string all_input() {
  std::string text;
  std::vector<char> buffer(1 << 20);
  for (;;) {
    const ssize_t got = read(STDIN_FILENO, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(buffer.data(), static_cast<std::size_t>(got));
  }
}

/// The request's surface as TetGen takes it. Each triangle has a mark of its own, its number counted from 1: then
/// TetGen does not join triangles of one plane, and names those that cross. False where the request is not one.
bool read_surface(const std::string& text, Request& request, tetgenio& surface) {
  if (text.size() < sizeof(Request)) return false;
  std::memcpy(&request, text.data(), sizeof(Request));
  const std::uint64_t left = text.size() - sizeof(Request);
  constexpr std::uint64_t point = 3 * sizeof(double), triangle = 3 * sizeof(std::uint32_t), most = 1 << 30;
  if (request.mark != request_mark || request.points > std::min(left / point, most) ||
      request.triangles > std::min(left / triangle, most) ||
      request.points * point + request.triangles * triangle != left)
    return false;
  surface.firstnumber = 0;
  surface.numberofpoints = static_cast<int>(request.points);
  surface.pointlist = new double[3 * request.points];
  std::memcpy(surface.pointlist, text.data() + sizeof(Request), request.points * point);
  surface.numberoffacets = static_cast<int>(request.triangles);
  surface.facetlist = new tetgenio::facet[request.triangles];
  surface.facetmarkerlist = new int[request.triangles];
  const char* corners = text.data() + sizeof(Request) + request.points * point;
  for (std::uint64_t t = 0; t < request.triangles; ++t, corners += triangle) {
    std::uint32_t three[3];
    std::memcpy(three, corners, triangle);
    tetgenio::facet& facet = surface.facetlist[t];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(facet.polygonlist);
    facet.polygonlist->numberofvertices = 3;
    facet.polygonlist->vertexlist = new int[3];
    for (int k = 0; k < 3; ++k) {
      if (three[k] >= request.points) return false;
      facet.polygonlist->vertexlist[k] = static_cast<int>(three[k]);
    }
    surface.facetmarkerlist[t] = static_cast<int>(t) + 1;
  }
  return true;
}

template <class T>
void append(std::string& text, const T* values, std::size_t count) {
  text.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

std::string filled(const Request& request, tetgenio& surface) {
  std::string switches = request.job == Job::Fill ? fill : fill_inside;
  tetgenio out;
  tetrahedralize(switches.data(), &surface, &out);
  Reply reply;
  reply.added = static_cast<std::uint64_t>(out.numberofpoints) - request.points;
  reply.tets = static_cast<std::uint64_t>(out.numberoftetrahedra);
  std::string text;
  append(text, &reply, 1);
  append(text, out.pointlist + 3 * request.points, 3 * reply.added);
  std::vector<std::uint32_t> regions;
  for (std::uint64_t t = 0; t < reply.tets; ++t) {
    const int* corner = out.tetrahedronlist + static_cast<std::ptrdiff_t>(t) * out.numberofcorners;
    const std::uint32_t tet[4] = {static_cast<std::uint32_t>(corner[0]), static_cast<std::uint32_t>(corner[1]),
                                  static_cast<std::uint32_t>(corner[2]), static_cast<std::uint32_t>(corner[3])};
    append(text, tet, 4);
    regions.push_back(
        out.numberoftetrahedronattributes > 0
            ? static_cast<std::uint32_t>(
                  out.tetrahedronattributelist[static_cast<std::ptrdiff_t>(t) * out.numberoftetrahedronattributes])
            : 0);
  }
  append(text, regions.data(), regions.size());
  return text;
}

std::string crossings(tetgenio& surface) {
  std::string switches = look_for_crossings;
  tetgenio out;
  tetrahedralize(switches.data(), &surface, &out);
  std::vector<std::uint32_t> triangles;
  for (int t = 0; t < out.numberoftrifaces; ++t)
    if (out.trifacemarkerlist != nullptr && out.trifacemarkerlist[t] > 0)
      triangles.push_back(static_cast<std::uint32_t>(out.trifacemarkerlist[t] - 1));
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  Reply reply;
  reply.crossing = triangles.size();
  std::string text;
  append(text, &reply, 1);
  append(text, triangles.data(), triangles.size());
  return text;
}

bool write_all(int to, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t wrote = write(to, text.data() + done, text.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return false;
    done += static_cast<std::size_t>(wrote);
  }
  return true;
}

Outcome answer_to(const std::string& input, int reply) {
  try {
    Request request;
    tetgenio surface;
    if (!read_surface(input, request, surface)) return BadUse;
    const std::string text = request.job == Job::Crossings ? crossings(surface) : filled(request, surface);
    return write_all(reply, text) ? Done : Failed;
  } catch (int code) {  // TetGen's: 1 memory, 3 crossing faces, 2 and above 3 its own mistakes or limits
    return code == 1 ? NoMemory : code == 3 ? Crossing : Failed;
  } catch (const std::bad_alloc&) {
    return NoMemory;
  }
}

}  // namespace

int main(int count, char** arguments) {
  std::uint64_t bytes = 0, seconds = 0;
  if (count != 3 || !number(arguments[1], bytes) || !number(arguments[2], seconds)) return BadUse;
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // nobody would read the reply
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, seconds);
#ifndef SINEW_SANITIZED  // whose shadow memory is larger than any limit
  set_limit(RLIMIT_AS, bytes);
#endif
  const int reply = take_standard_output();
  try {
    _exit(answer_to(all_input(), reply));  // at once: what TetGen left behind is no matter
  } catch (const std::bad_alloc&) {
    _exit(NoMemory);
  }
}
