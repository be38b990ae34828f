#include "deformers/methods.h"

#include "deformers/graph.h"
#include "deformers/shell.h"
#include "deformers/tet.h"

namespace sinew {

std::span<const Method> methods() {
  static const Method table[] = {graph_method(), tet_method(), shell_method()};
  return table;
}

}  // namespace sinew
