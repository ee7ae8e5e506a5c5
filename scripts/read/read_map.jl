# Reads a map of decay rates with Julia: a value, a condition on the status, a picture with the exact boundaries.
#
#     slipmap run sweeps/decay_load.toml
#     julia -e 'using Pkg; Pkg.add(["NCDatasets", "Interpolations", "CairoMakie"])'
#     julia read_map.jl decay_load.h5 picture.png
#
# Dimensions are in reverse order here: tau, alpha_n, mu_prime.

using CairoMakie, Interpolations, NCDatasets

path, picture = ARGS
cells = NCDataset(path)
mu_prime, alpha_n, tau = (cells[name][:] for name in ("mu_prime", "alpha_n", "tau"))

# By physical value: the nearest cell. One plane of a large map is read on its own.
nearest(axis, value) = argmin(abs.(axis .- value))
i, j, k = nearest(mu_prime, -0.3), nearest(alpha_n, -1.5), nearest(tau, 0.8)
# As stored: missing values stay NaN, the status stays an integer.
abscissa = cells["abscissa"].var[:, :, i]
status = cells["status"].var[:, :, i]
println("nearest ", join((mu_prime[i], alpha_n[j], tau[k], abscissa[k, j]), " "))

# Between cells.
at = interpolate((tau, alpha_n), abscissa, Gridded(Linear()))
println("interpolated ", at(0.8, -1.5))

# By status: only cells whose abscissa a second method has confirmed.
flags = Dict(zip(split(cells["status"].attrib["flag_meanings"]), cells["status"].attrib["flag_masks"]))
certified = (status .& flags["certified"]) .!= 0
println("certified ", count(certified), " of ", length(certified))

drawing = Figure()
axis = Axis(drawing[1, 1]; xlabel = "alpha_n", ylabel = "tau", title = "mu_prime = $(mu_prime[i])")
heat = heatmap!(axis, alpha_n, tau, permutedims(ifelse.(certified, abscissa, NaN));
    colormap = Reverse(:BrBG), colorrange = (-1, 1))
Colorbar(drawing[1, 2], heat; label = "abscissa")

# The boundary of stability as exact curves, one after the other.
curves = cells.group["boundaries"]
counts = curves["vertex_count"].var[:]
ends = cumsum(counts)
boundary = (curves["mu_prime"].var[:] .== mu_prime[i]) .& (curves["degree_of_stability"].var[:] .== 0) .&
    (curves["stable_side"].var[:] .!= 0)
for n in findall(boundary)
    vertices = (ends[n] - counts[n] + 1):ends[n]
    lines!(axis, curves["alpha_n"].var[vertices], curves["tau"].var[vertices]; color = :black)
end
save(picture, drawing)
