#include "program.hpp"

int main(int count, char** arguments) { return mpmfast::run_program(count, arguments); }
