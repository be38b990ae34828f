// TetGen's own terminatetetgen frees what the destructor of the mesh frees again. Its symbol is weak: this one stands
// in its place, in a file that doesn't see the inline one. The library calls it through the table of the program's
// symbols.

class tetgenmesh;

__attribute__((visibility("default"))) void terminatetetgen(tetgenmesh* mesh, int code);

void terminatetetgen(tetgenmesh*, int code) {
  throw code;
}
