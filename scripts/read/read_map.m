% Reads a map of decay rates with MATLAB or Octave: a value, a condition on the status, a picture with the exact boundaries.
%
%     slipmap run sweeps/decay_load.toml
%     matlab -batch "path = 'decay_load.h5'; picture = 'picture.png'; read_map"
%     octave-cli --eval "path = 'decay_load.h5'; picture = 'picture.png'; read_map"
%
% Octave needs its package netcdf. Dimensions are in reverse order here: tau, alpha_n, mu_prime.

if exist('OCTAVE_VERSION', 'builtin')
    pkg load netcdf
end

mu_prime = ncread(path, 'mu_prime');
alpha_n = ncread(path, 'alpha_n');
tau = ncread(path, 'tau');

% By physical value: the nearest cell. One plane of a large map is read on its own, by where it starts and how much it is.
[~, i] = min(abs(mu_prime + 0.3));
[~, j] = min(abs(alpha_n + 1.5));
[~, k] = min(abs(tau - 0.8));
abscissa = ncread(path, 'abscissa', [1 1 i], [Inf Inf 1]);
fprintf('nearest %.17g %.17g %.17g %.17g\n', mu_prime(i), alpha_n(j), tau(k), abscissa(k, j));

% Between cells.
fprintf('interpolated %.17g\n', interp2(alpha_n, tau, abscissa, -1.5, 0.8));

% By status: only cells whose abscissa a second method has confirmed.
flags = strsplit(ncreadatt(path, 'status', 'flag_meanings'));
masks = ncreadatt(path, 'status', 'flag_masks');
status = uint8(ncread(path, 'status', [1 1 i], [Inf Inf 1]));
certified = bitand(status, uint8(masks(strcmp(flags, 'certified')))) ~= 0;
fprintf('certified %d of %d\n', nnz(certified), numel(certified));
abscissa(~certified) = NaN;

drawing = figure('Visible', 'off');
pcolor(alpha_n, tau, abscissa);
shading flat
axis tight
% Teal decays, brown grows.
steps = [0 0.5 1]';
colormap(interp1(steps, [0 0.35 0.3; 1 1 1; 0.55 0.3 0], linspace(0, 1, 255)));
caxis([-1 1]);
colorbar
xlabel('alpha_n', 'Interpreter', 'none');
ylabel('tau');
title(sprintf('abscissa at mu_prime = %g', mu_prime(i)), 'Interpreter', 'none');

% The boundary of stability as exact curves, one after the other.
if exist('OCTAVE_VERSION', 'builtin')
    boundaries = load('-hdf5', path, 'boundaries').boundaries;
    curves = @(name) boundaries.(name)';
else
    curves = @(name) h5read(path, ['/boundaries/' name]);
end
counts = double(curves('vertex_count'));
x = mat2cell(curves('alpha_n'), counts);
y = mat2cell(curves('tau'), counts);
boundary = curves('mu_prime') == mu_prime(i) & curves('degree_of_stability') == 0 & curves('stable_side') ~= 0;
hold on
for n = find(boundary)'
    plot(x{n}, y{n}, 'k');
end
print(drawing, picture, '-dpng', '-r150');
