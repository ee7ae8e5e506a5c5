# Reads a map of decay rates with R: a value, a condition on the status, a picture with the exact boundaries.
#
#     slipmap run sweeps/decay_load.toml
#     Rscript read_map.R decay_load.h5 picture.png
#
# Needs the package hdf5r. Dimensions are in reverse order here: tau, alpha_n, mu_prime.

library(hdf5r)

arguments <- commandArgs(trailingOnly = TRUE)
cells <- H5File$new(arguments[1], mode = "r")
picture <- arguments[2]
mu_prime <- cells[["mu_prime"]][]
alpha_n <- cells[["alpha_n"]][]
tau <- cells[["tau"]][]

# By physical value: the nearest cell. Of a large map only what is asked for is read, here one plane.
nearest <- function(axis, value) which.min(abs(axis - value))
i <- nearest(mu_prime, -0.3)
j <- nearest(alpha_n, -1.5)
k <- nearest(tau, 0.8)
abscissa <- cells[["abscissa"]][, , i]
cat("nearest", sprintf("%.17g", c(mu_prime[i], alpha_n[j], tau[k], abscissa[k, j])), "\n")

# Between cells: linear along tau in the columns on both sides, then between these.
sides <- findInterval(-1.5, alpha_n) + 0:1
along_tau <- sapply(sides, function(side) approx(tau, abscissa[, side], 0.8)$y)
cat("interpolated", sprintf("%.17g", approx(alpha_n[sides], along_tau, -1.5)$y), "\n")

# By status: only cells whose abscissa a second method has confirmed.
status <- cells[["status"]]
flags <- h5attr(status, "flag_masks")
names(flags) <- strsplit(h5attr(status, "flag_meanings"), " ")[[1]]
certified <- bitwAnd(status[, , i], flags["certified"]) != 0
cat("certified", sum(certified), "of", length(certified), "\n")
abscissa[!certified] <- NA

png(picture, width = 900, height = 700, res = 150)
# Teal decays, brown grows; what is beyond the colours has that of their end.
colours <- rev(hcl.colors(255, "BrBG"))
image(alpha_n, tau, t(pmin(pmax(abscissa, -1), 1)), zlim = c(-1, 1), col = colours, useRaster = TRUE,
      main = paste("abscissa at mu_prime =", mu_prime[i]))

# The boundary of stability as exact curves, one after the other.
curves <- function(name) cells[["boundaries"]][[name]][]
count <- curves("vertex_count")
curve <- rep(seq_along(count), count)
x <- split(curves("alpha_n"), curve)
y <- split(curves("tau"), curve)
boundary <- curves("mu_prime") == mu_prime[i] & curves("degree_of_stability") == 0 & curves("stable_side") != 0
for (n in which(boundary)) {
  lines(x[[n]], y[[n]])
}
invisible(dev.off())
