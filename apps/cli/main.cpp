#include "commands.h"

int main(int argument_count, char** arguments) { return relief::cli::run(argument_count, arguments); }
