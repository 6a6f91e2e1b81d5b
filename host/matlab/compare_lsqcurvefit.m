function compare_lsqcurvefit(starts)
% COMPARE_LSQCURVEFIT  The paper's three sets with noise, fitted by lsqcurvefit and by brdfit_fit, side by side.
%
%   compare_lsqcurvefit        % forty starts of lsqcurvefit for each set
%   compare_lsqcurvefit(250)   % as many as in the paper
%
%   lsqcurvefit fits ln brdf from starts uniform in the logarithms over four decades below the upper bounds of
%   Table 1, which suits it better than the paper's, uniform over the bounds, with its usual options but for
%   tolerances of 1e-10; of its fits the best counts. Octave needs the package optim, MATLAB its Optimization Toolbox.

    if nargin < 1
        starts = 40;
    end
    if exist('OCTAVE_VERSION', 'builtin')
        before = warning('off', 'all');
        pkg('load', 'optim');
        warning(before);
    end
    rand('twister', 1);
    data = fullfile(fileparts(mfilename('fullpath')), '..', '..', 'tests', 'data');
    [lower, upper] = deal([0 0 0 1e-5 1 0], [1 100 100 10 100 100]);
    options = optimset('TolFun', 1e-10, 'TolX', 1e-10, 'Display', 'off');
    for set = 1:3
        table = dlmread(fullfile(data, sprintf('testdata%d_sym_seed1.csv', set)), ',', 1, 0);
        [ti, ts, f] = deal(table(:, 1), table(:, 2), table(:, 3));
        model = @(x, angles) log(max(eq14(x, angles(:, 1), angles(:, 2)), realmin));
        best = Inf;
        failed = 0;
        ends = zeros(1, starts);
        tic;
        for k = 1:starts
            start = max(lower, upper .* 10 .^ (-4 * rand(1, 6)));
            try
                [x, ends(k)] = lsqcurvefit(model, start, [ti ts], log(f), lower, upper, options);
            catch
                ends(k) = Inf;
                failed = failed + 1;
            end
            if ends(k) < best
                best = ends(k);
                theirs = x(:).';
            end
        end
        their_time = toc;
        brdfit_fit(ti, ts, f);
        repeats = 10;
        tic;
        for k = 1:repeats
            [ours, resnorm] = brdfit_fit(ti, ts, f);
        end
        our_time = toc / repeats;
        fprintf('\nTest data %d, %d samples\n', set, numel(f));
        fprintf('%-34s %10s %12s %9s %9s %9s %9s %9s %9s\n', '', 'time, s', 'MSE^2', 'rho_d', 'rho_s', 'rho_v', 'm', 'n', 'kappa');
        line(sprintf('lsqcurvefit, best of %d starts', starts), their_time, best / numel(f)^2, theirs);
        line('brdfit_fit', our_time, resnorm / numel(f)^2, ours);
        fprintf('%d of %d starts of lsqcurvefit came within 1 %% of the MSE^2 of brdfit_fit; %d ended in an error\n', ...
            sum(ends <= 1.01 * resnorm), starts, failed);
    end
end

function line(name, time, mse2, x)
    fprintf('%-34s %10.4f %12.6g %9.4g %9.4g %9.4g %9.4g %9.4g %9.4g\n', name, time, mse2, x);
end
