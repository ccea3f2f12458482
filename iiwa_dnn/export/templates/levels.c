
/* Resolve the levels of priority of the program that begins a row. */
static void resolve_levels(double *row)
{
    double data[@data@];
    double x[@x@];
    double missing[@missing@];
    struct priorities priorities;
    priorities.numbers = level_numbers;
    priorities.rows = level_of_rows;
    priorities.data = data;
    priorities.x = x;
    priorities.missing = missing;
    priorities.settings = level_settings;
    priorities.tol = @tol@;
    resolve_program(row, @n@, @m@, @p@, &priorities);
}
