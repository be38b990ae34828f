#pragma once
/// Solids of the sizes of Table 3.1 of Stoll, de Aguiar, Theobalt and Seidel 2007, and what is done to them.

#include <memory>
#include <span>
#include <string>

#include "tests/benchmarks/cases.h"

namespace sinew::benchmarks {

/// A row of the table: sizes; seconds on an AMD X2 5000+; 0 where the report has none.
struct SolidRow {
  const char* name;
  const char* edit;  ///< the sample whose edit is done
  std::size_t input, vertices, tets;
  double fact, trans, recons, fps;
  double cell;  ///< of the cactus of about so many input vertices, one whose edges all have two faces
};
std::span<const SolidRow> solid_rows();

/// The shape of a row, closed. A shape without input has its vertices already, the others are to be simplified to them.
std::shared_ptr<const Shape> solid_shape(const SolidRow& row);

/// The shape of a row, its handle at rest: what dragged() takes.
Case solid_case(const SolidRow& row);

}  // namespace sinew::benchmarks
