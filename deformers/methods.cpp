#include "deformers/methods.h"

#include "deformers/graph.h"

namespace sinew {

std::span<const Method> methods() {
  static const Method table[] = {graph_method()};
  return table;
}

}  // namespace sinew
