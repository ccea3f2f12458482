/* What an exported controller needs of C's mathematics; the page gives it JavaScript's. */
#define INFINITY __builtin_inf()
#define NAN __builtin_nan("")
#define isnan(x) __builtin_isnan(x)
#define isinf(x) __builtin_isinf(x)
#define isfinite(x) __builtin_isfinite(x)

#define copysign(x, y) __builtin_copysign(x, y)

double atan2(double y, double x);
double ceil(double x);
double cos(double x);
double fabs(double x);
double floor(double x);
double fmod(double x, double y);
double sin(double x);
double sqrt(double x);
