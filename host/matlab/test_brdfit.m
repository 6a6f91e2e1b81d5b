function test_brdfit(expected, expected_ggx, expected_sigma, with_sigma)
% TEST_BRDFIT  Tests of brdfit_fit and brdfit_brdf.
%
%   test_brdfit
%   test_brdfit('fits.csv')   also compares bits with what the program printed:
%                             brdfit fit tests/data/testdata1_sym_seed1.csv tests/data/testdata2_sym_seed1.csv ... --format csv
%   test_brdfit('fits.csv', 'ggx.csv')   and what it printed with --model ggx
%   test_brdfit('fits.csv', 'ggx.csv', 'sigma.csv', 'scan.csv')   and of a scan with a column of standard deviations

    data = fullfile(fileparts(mfilename('fullpath')), '..', '..', 'tests', 'data');
    names = {'testdata1_sym_seed1.csv', 'testdata2_sym_seed1.csv', 'testdata3_sym_seed1.csv'};
    for k = 1:numel(names)
        table = dlmread(fullfile(data, names{k}), ',', 1, 0);
        [ti, ts, f] = deal(table(:, 1), table(:, 2), table(:, 3));
        [x, resnorm, residual, exitflag, output] = brdfit_fit(ti, ts, f);
        assert(exitflag == 1 || exitflag == 2);
        % What comes out belongs together.
        assert(isequal(size(residual), size(f)) && isequal(size(x), [1 6]));
        close_to(sum(residual.^2), resnorm, 1e-12);
        close_to(output.mse2, resnorm / numel(f)^2, 1e-15);
        close_to(exp(residual), brdfit_brdf(ti, ts, x) ./ f, 1e-14);
        close_to(brdfit_brdf(ti, ts, x), eq14(x, ti, ts), 1e-11);
        assert(isequal(output.minima(1).x, x) && output.minima(1).resnorm == resnorm && output.minima(1).hits >= 1);
        assert(output.funcCount > output.iterations && output.iterations > 0);
        % It is a minimum within the bounds: no small step in any parameter lowers resnorm.
        [lower, upper] = deal([0 0 0 1e-5 1 0], [1 100 100 10 100 100]);
        for p = 1:6
            for step = [-1e-3, 1e-3]
                y = x;
                y(p) = min(max(x(p) + step * max(x(p), 1e-3), lower(p)), upper(p));
                assert(sum((log(eq14(y, ti, ts)) - log(f)).^2) >= resnorm * (1 - 1e-12));
            end
        end
        % As many standard errors as parameters inside their bounds.
        assert(max(abs(diag(output.correlation) - (output.stderr.' > 0))) < 1e-14 && output.condition >= 1);
        close_to(output.scale, sqrt(resnorm / (numel(f) - sum(output.stderr > 0))), 1e-12);
        % Rows and one number for theta_i change nothing.
        assert(isequal(brdfit_fit(ti(1), ts.', f.'), x));
        assert(isequal(brdfit_fit(ti, ts, f, struct('sigma', [], 'delta_phi', 180, 'seed', [])), x));
        if nargin > 0
            same_bits(expected, k, x, output.mse2);
            same_errors(expected, k, output);
        end
        % GGX, and the better of both.
        [y, resnorm_y, residual_y, ~, output_y] = brdfit_fit(ti, ts, f, struct('model', 'ggx'));
        close_to(sum(residual_y.^2), resnorm_y, 1e-12);
        close_to(exp(residual_y), brdfit_brdf(ti, ts, y, [], 'ggx') ./ f, 1e-14);
        assert(~isequal(x, y) && strcmp(output_y.model, 'ggx') && strcmp(output.model, 'beckmann'));
        [z, resnorm_z, ~, ~, output_z] = brdfit_fit(ti, ts, f, struct('model', 'auto'));
        assert(resnorm_z == min(resnorm, resnorm_y) && isequal(z, x) == strcmp(output_z.model, 'beckmann'));
        if nargin > 1
            same_bits(expected_ggx, k, y, output_y.mse2);
            same_errors(expected_ggx, k, output_y);
        end
    end

    % Options.
    [y, resnorm_y] = brdfit_fit(ti, ts, f, struct('terms', 'diffuse, surface'));
    assert(y(3) == 0 && y(6) == 0 && resnorm_y >= resnorm);
    assert(isequal(brdfit_fit(ti, ts, f, struct('terms', {{'surface', 'diffuse'}})), y));
    y = brdfit_fit(ti, ts, f, struct('lb', [0 0 0 1e-5 1.5 0], 'ub', [1 100 100 10 1.5 0]));
    assert(y(5) == 1.5 && y(6) == 0);
    [~, resnorm_y, ~, flag] = brdfit_fit(ti, ts, f, struct('MaxFunEvals', 1, 'candidates', 1));
    assert(flag == 0 && resnorm_y > resnorm);
    % What nlparci would say of three parameters, with derivatives by differences.
    % Noise is above and below the model in turn, so that no correlation of neighbours is likelier than none.
    options = struct('lb', [0 0 0.05 1e-5 1.5 0.5], 'ub', [1 100 0.05 10 1.5 0.5]);
    signs = 1 - 2 * mod((1:numel(f)).', 2);
    clean = eq14([0.1 5 0.05 0.1 1.5 0.5], ti, ts);
    noisy = clean .* (1 + 0.03 * signs);
    [y, resnorm_y, ~, ~, output] = brdfit_fit(ti, ts, noisy, options);
    assert(isnan(output.correlated_over_deg));
    free = [1 2 4];
    for k = 1:3
        [up, down] = deal(y);
        step = 1e-5 * y(free(k));
        up(free(k)) = y(free(k)) + step;
        down(free(k)) = y(free(k)) - step;
        J(:, k) = (log(eq14(up, ti, ts)) - log(eq14(down, ti, ts))) / (2 * step);
    end
    covariance = resnorm_y / (numel(f) - 3) * inv(J.' * J);
    close_to(output.stderr(free), sqrt(diag(covariance)).', 1e-5);
    assert(isequal(output.stderr([3 5 6]), [0 0 0]));
    close_to(output.correlation(1, 2), covariance(1, 2) / sqrt(covariance(1, 1) * covariance(2, 2)), 1e-4);
    % Errors of a sigma that chi^2 does not refute are its own, whatever the residuals; of one that it does, those of these.
    scale = output.scale;
    [~, ~, ~, ~, own] = brdfit_fit(ti, ts, noisy, setfield(options, 'sigma', scale * clean));
    [~, ~, ~, ~, refuted] = brdfit_fit(ti, ts, noisy, setfield(options, 'sigma', 2 * scale * clean));
    close_to(own.stderr(free), output.stderr(free), 0.2);
    close_to(refuted.stderr(free), output.stderr(free), 0.2);
    % Twice the sigma is a quarter of resnorm, but for what such noise takes from ln f; a sample with a large one hardly counts.
    [~, one] = brdfit_fit(ti, ts, f, struct('sigma', 1e-3 * f));
    [~, half, residual] = brdfit_fit(ti, ts, f, struct('sigma', 2e-3 * f));
    close_to(half, one / 4, 1e-3);
    close_to(sum(residual.^2), half, 1e-12);
    if nargin > 2
        table = dlmread(with_sigma, ',', 1, 0);
        [y, ~, ~, ~, output] = brdfit_fit(table(:, 1), table(:, 2), table(:, 3), struct('sigma', table(:, 4)));
        same_bits(expected_sigma, 1, y, output.mse2);
        same_errors(expected_sigma, 1, output);
    end
    spoilt = f;
    spoilt(7) = 100 * f(7);
    sigma = 1e-3 * f;
    sigma(7) = 1e9 * f(7);
    others = [1:6, 8:numel(f)];
    without = brdfit_fit(ti(others), ts(others), f(others), struct('sigma', sigma(others)));
    close_to(brdfit_fit(ti, ts, spoilt, struct('sigma', sigma))(1), without(1), 1e-6);
    % The program itself; jsondecode may round the last digit.
    names = {'rho_d', 'rho_s', 'rho_v', 'm', 'n', 'kappa'};
    values = @(result) cellfun(@(name) result.parameters.(name), names);
    whole = brdfit_program('fit', ti, ts, f);
    assert(max(abs(values(whole) - x) ./ max(x, 1e-300)) < 1e-14 && strcmp(whole.model, 'beckmann') && isfield(whole, 'derived'));
    weighted = brdfit_program('fit', ti, ts, f, struct('sigma', 0.1 * f + 0.001, 'delta_phi', 180));
    close_to(values(weighted)(1), brdfit_fit(ti, ts, f, struct('sigma', 0.1 * f + 0.001))(1), 1e-14);
    other = brdfit_program('fit', ti, ts, f, struct('model', 'ggx-smith', 'robust', true, 'prior', {{'n=3+-1', 'm=0.1+-1'}}, 'seed', 3, 'fit_offset', false));
    assert(strcmp(other.model, 'ggx-smith') && isfield(other.uncertainty, 'undetermined'));
    chosen = brdfit_program('fit', ti, ts, f, struct('terms', 'auto', 'method', 'paper', 'starts', 20));
    assert(isfield(chosen, 'selection') && numel(brdfit_program('compare', ti, ts, f, struct('models', 'abg,ggx')).models) == 2);
    % Out of plane.
    [a, b] = deal(brdfit_brdf(30, 40, x, 180), brdfit_brdf(30, -40, x, 0));
    close_to(a, b, 1e-12);

    % Mistakes.
    fails('brdfit:badInput', @() brdfit_fit(ti, ts));
    fails('brdfit:badInput', @() brdfit_fit(ti, ts, []));
    fails('brdfit:badInput', @() brdfit_fit('a', ts, f));
    fails('brdfit:badInput', @() brdfit_fit(ti, ts, f + 1i));
    fails('brdfit:sizeMismatch', @() brdfit_fit(ti, ts(1:end - 1), f));
    fails('brdfit:badOption', @() brdfit_fit(ti, ts, f, 7));
    fails('brdfit:badOption', @() brdfit_fit(ti, ts, f, struct('colour', 'red')));
    fails('brdfit:badOption', @() brdfit_fit(ti, ts, f, struct('seed', -1)));
    fails('brdfit:badOption', @() brdfit_fit(ti, ts, f, struct('TolX', -1)));
    fails('brdfit:badTerms', @() brdfit_fit(ti, ts, f, struct('terms', 'shiny')));
    fails('brdfit:badTerms', @() brdfit_fit(ti, ts, f, struct('terms', 'volume')));
    fails('brdfit:badTerms', @() brdfit_fit(ti, ts, f, struct('model', 'ggx', 'terms', 'diffuse')));
    fails('brdfit:badModel', @() brdfit_fit(ti, ts, f, struct('model', 'phong')), 'beckmann, ggx');
    fails('brdfit:badModel', @() brdfit_brdf(45, 45, x, 180, 'phong'));
    fails('brdfit:badBounds', @() brdfit_fit(ti, ts, f, struct('lb', [0 0])));
    fails('brdfit:badBounds', @() brdfit_fit(ti, ts, f, struct('lb', [2 0 0 1e-5 1 0])));
    fails('brdfit:notFinite', @() brdfit_fit(ti, ts, [NaN; f(2:end)]), 'sample 1:');
    fails('brdfit:notPositive', @() brdfit_fit(ti, ts, [f(1:end - 1); 0]), sprintf('sample %d:', numel(f)));
    fails('brdfit:notPositive', @() brdfit_fit(ti, ts, f, struct('sigma', -f)));
    fails('brdfit:beyondHorizon', @() brdfit_fit(95, ts, f));
    fails('brdfit:tooFewSamples', @() brdfit_fit(ti(1:5), ts(1:5), f(1:5)));
    fails('brdfit:badParameters', @() brdfit_brdf(45, 45, [0 0 0 1 0 0]));
    fails('brdfit:badParameters', @() brdfit_brdf(45, 45, [0 0 0]));
    fails('brdfit:program', @() brdfit_program('fit', ti, ts, f, struct('model', 'phong')), 'there is no model ''phong''');
    fails('brdfit:program', @() brdfit_program('fit', ti, ts, -f), 'no logarithm');
    fails('brdfit:badInput', @() brdfit_program('batch', ti, ts, f));
    fails('brdfit:badOption', @() brdfit_program('fit', ti, ts, f, struct('robust', {{1}})));
    fails('brdfit:badOption', @() brdfit_program('fit', ti, ts, f, struct('output', sprintf('a\nb'))));
    fails('brdfit:sizeMismatch', @() brdfit_program('fit', ti, ts(2:end), f));
    disp('test_brdfit: all passed');
end

function close_to(a, b, tolerance)
    distance = max(abs(a(:) - b(:)) ./ abs(b(:)));
    assert(distance <= tolerance, 'differs by %g, allowed is %g', distance, tolerance);
end

function fails(identifier, call, part)
    if nargin < 3
        part = 'brdfit';
    end
    caught = '';
    message = '';
    try
        call();
    catch problem
        caught = problem.identifier;
        message = problem.message;
    end
    assert(strcmp(caught, identifier), 'expected %s, got "%s" (%s)', identifier, caught, message);
    assert(~isempty(strfind(message, part)), 'expected "%s" in "%s"', part, message);
end

function value = row_of(file, row)
    lines = strsplit(strtrim(fileread(file)), sprintf('\n'));
    columns = strsplit(lines{1}, ',', 'CollapseDelimiters', false);
    cells = strsplit(lines{row + 1}, ',', 'CollapseDelimiters', false);
    value = @(name) str2double(cells{strcmp(columns, name)});
end

function same_errors(file, row, output)
    value = row_of(file, row);
    names = {'rho_d', 'rho_s', 'rho_v', 'm', 'n', 'kappa'};
    for p = 1:6
        assert(same(output.stderr(p), value(['stderr_' names{p}])), '%s: %g and %g', names{p}, output.stderr(p), value(['stderr_' names{p}]));
    end
    assert(same(output.coverage_factor_95, value('coverage_factor_95')));
    assert(same(output.correlated_over_deg, value('correlated_over_deg')));
    assert(isnan(output.correlated_over_deg) == isequal(output.error_factor, [1 1]));
    assert(isnan(output.correlated_over_deg) || same(output.error_factor(2), value('error_factor')));
end

% An empty cell stands for no error, and for one that is not known. The errors of the fit once more may differ in the last digits.
function yes = same(found, expected)
    yes = isequaln(found, expected) || abs(found / expected - 1) < 1e-9 || (isnan(expected) && (found == 0 || isinf(found)));
end

function same_bits(file, row, x, mse2)
    value = row_of(file, row);
    names = {'rho_d', 'rho_s', 'rho_v', 'm', 'n', 'kappa'};
    for p = 1:6
        assert(isequal(x(p), value(names{p})), '%s differs from the program''s', names{p});
    end
    assert(isequal(mse2, value('mse2')), 'mse2 differs from the program''s');
end
