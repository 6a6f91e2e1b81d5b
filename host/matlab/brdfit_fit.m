function [x, resnorm, residual, exitflag, output] = brdfit_fit(theta_i, theta_s, brdf, options)
% BRDFIT_FIT  Parameters of a microfacet BRDF model from a scan: the global optimum, without a start.
%
%   x = brdfit_fit(theta_i, theta_s, brdf)
%   x = brdfit_fit(theta_i, theta_s, brdf, options)
%   [x, resnorm, residual, exitflag, output] = brdfit_fit(...)
%
%   All angles are in DEGREES.
%   theta_i   angles of incidence, 0 <= theta_i < 90; an array like brdf, or one number
%   theta_s   scattering angles, -90 < theta_s < 90; in plane positive forward, towards the specular peak
%   brdf      measured BRDF in sr^-1, above 0
%
%   x         [rho_d rho_s rho_v m n kappa], dimensionless (Eq. 14 of Bishop, Butler and Marciniak, 2021, or GGX);
%             of absent terms rho and kappa are 0, m and n are 1
%   resnorm   sum(residual(:).^2)
%   residual  ln of the model less ln brdf; of the size of brdf. With a sigma over the standard deviation of ln brdf, which
%             is that of sigma over the fitted brdf, and with ln brdf raised by what noise of that size takes from it on average
%   exitflag  1: converged, 2: converged as far as rounding allows, 0: too many evaluations, as in lsqcurvefit
%   output    .iterations, .funcCount (model evaluations over the whole scan), .algorithm, .message, .mse2 (Eq. 17, with weights whose squares have a mean of 1),
%             .model (its name), .minima (a struct array of the distinct minima found, best first: .x, .resnorm, .mse2, .hits),
%             .stderr (standard errors of x; 0 where absent, held or on a bound, Inf where nothing is known),
%             .correlation (6 x 6), .coverage_factor_95 (so many standard errors are the half of a 95 % interval),
%             .effective_degrees_of_freedom, .correlated_over_deg (angle over which residuals are alike; NaN if they are
%             independent), .error_factor (least and largest factor by which that raises the errors), .scale (standard
%             deviation of a residual), .condition (of the scaled J'J; above about 1e6 some parameters are known only
%             together)
%
%   The errors are those of the program and of the Python package: where residuals wander along the angle, as those of
%   most measured scans do, they are larger than those of nlparci, which are for independent residuals. With options.sigma
%   they are those of sigma, unless chi^2 refutes it. They are of the minimum that x leads to, where a fit was stopped.
%
%   options is a struct with any of these fields; empty ones count as not given:
%   delta_phi    azimuth of scattering less that of incidence in degrees; 180, in plane
%   sigma        standard deviations of brdf in sr^-1, weighed as the program and Python do it; none, so that all samples
%                have the same relative weight
%   model        'beckmann' for Eq. 14, 'ggx' for the same with the wider tails of GGX, or 'auto' for the one that fits
%                better: both have six parameters, so it has the least BIC; 'beckmann'
%   terms        'all', or some of 'diffuse', 'surface', 'volume', 'absorbing' with commas between; 'all', which GGX needs
%   lb, ub       bounds of x, as in lsqcurvefit; Table 1 of the paper: [0 0 0 1e-5 1 0], [1 100 100 10 100 100];
%                equal ones hold a parameter fixed
%   seed         of the search, an integer from 0 to 2^53; 0
%   candidates   largest number of candidates of the search; 435
%   MaxFunEvals  largest number of evaluations of one fit; 500
%   TolFun, TolX relative tolerances in resnorm and in x; eps
%
%   The same input gives the same bits of x and resnorm on every machine, and those of the program brdfit.
%
%   Errors: brdfit:badInput, brdfit:sizeMismatch, brdfit:badOption, brdfit:badModel, brdfit:badTerms, brdfit:badBounds,
%   brdfit:notFinite, brdfit:beyondHorizon, brdfit:notPositive, brdfit:tooFewSamples, brdfit:noFit.
%
%   brdfit_program has the other models and options of the program.
%
%   See also brdfit_brdf, brdfit_program, lsqcurvefit.

    if nargin < 3 || nargin > 4
        error('brdfit:badInput', 'brdfit_fit: takes theta_i, theta_s, brdf and, if need be, options');
    end
    if nargin < 4 || isempty(options)
        options = struct();
    end
    if ~isstruct(options) || numel(options) ~= 1
        error('brdfit:badOption', 'brdfit_fit: options must be one struct');
    end
    settings = struct('delta_phi', 180, 'sigma', [], 'model', 'beckmann', 'terms', 'all', ...
        'lb', [0 0 0 1e-5 1 0], 'ub', [1 100 100 10 100 100], 'seed', 0, 'candidates', NaN, 'MaxFunEvals', NaN, 'TolFun', NaN, 'TolX', NaN);
    names = fieldnames(options);
    for k = 1:numel(names)
        if isempty(options.(names{k}))
            continue
        end
        if ~isfield(settings, names{k})
            error('brdfit:badOption', 'brdfit_fit: there is no option %s; see help brdfit_fit', names{k});
        end
        settings.(names{k}) = options.(names{k});
    end

    if ~isnumeric(brdf) || ~isreal(brdf) || isempty(brdf)
        error('brdfit:badInput', 'brdfit_fit: brdf must be an array of real numbers');
    end
    radian = pi / 180;
    f = double(brdf(:).');
    ti = brdfit_row('theta_i', theta_i, numel(f)) * radian;
    ts = brdfit_row('theta_s', theta_s, numel(f)) * radian;
    dphi = brdfit_row('options.delta_phi', settings.delta_phi, numel(f)) * radian;
    sigma_over_f = ones(size(f));
    if ~isempty(settings.sigma)
        sigma_over_f = brdfit_row('options.sigma', settings.sigma, numel(f)) ./ f;
    end
    numbers = [whole('seed', settings.seed, 0, 2^53), terms_number(settings.terms), ...
        whole('candidates', settings.candidates, 1, 2^32 - 1), whole('MaxFunEvals', settings.MaxFunEvals, 1, 2^32 - 1), ...
        number('TolFun', settings.TolFun), number('TolX', settings.TolX)];
    has_sigma = double(~isempty(settings.sigma));

    models = {settings.model};
    if strcmp(settings.model, 'auto')
        models = {'beckmann', 'ggx'};
    end
    resnorm = Inf;
    for k = 1:numel(models)
        [fitted{1:7 + (nargout > 4)}] = brdfit_mex('fit', [ti; ts; dphi; f; sigma_over_f], [numbers, brdfit_model(models{k}), has_sigma], ...
            bound('lb', settings.lb), bound('ub', settings.ub));
        if fitted{2} / fitted{7}^2 < resnorm
            [x, cost, stop, passes, minima, samples, unit] = fitted{1:7};
            resnorm = cost / unit^2;
            known = fitted{end};
            model = models{k};
        end
    end

    if nargout > 2
        value = brdfit_mex('brdf', [ti; ts; dphi], x, brdfit_model(model));
        residual = reshape((log(value) - log(samples(1, :))) .* samples(2, :) / unit, size(brdf));
    end
    flags = [1 2 0];
    messages = {'converged in resnorm', 'converged as far as rounding allows', 'MaxFunEvals evaluations were made'};
    exitflag = flags(stop);
    if nargout > 4
        output = struct('iterations', passes(1), 'funcCount', passes(2) + passes(3), ...
            'algorithm', 'global search with bounded Levenberg-Marquardt', 'message', messages{stop}, ...
            'mse2', cost / numel(f)^2, 'model', model);
        output.stderr = known(1:6);
        output.correlation = reshape(known(7:42), 6, 6);
        output.coverage_factor_95 = known(43);
        output.effective_degrees_of_freedom = known(44);
        output.correlated_over_deg = known(45);
        output.error_factor = known(46:47);
        output.scale = known(48);
        output.condition = known(49);
        output.minima = struct('x', {}, 'resnorm', {}, 'mse2', {}, 'hits', {});
        for k = 1:size(minima, 2)
            output.minima(k) = struct('x', minima(1:6, k).', 'resnorm', minima(7, k) / unit^2, ...
                'mse2', minima(7, k) / numel(f)^2, 'hits', minima(8, k));
        end
    end
end

function value = number(name, value)
    if ~isnumeric(value) || ~isreal(value) || numel(value) ~= 1
        error('brdfit:badOption', 'brdfit_fit: options.%s must be a number', name);
    end
    value = double(value);
end

function value = whole(name, value, least, largest)
    value = number(name, value);
    if ~isnan(value) && ~(value >= least && value <= largest && value == floor(value))
        error('brdfit:badOption', 'brdfit_fit: options.%s must be an integer from %g to %g', name, least, largest);
    end
end

function value = bound(name, value)
    if ~isnumeric(value) || ~isreal(value) || numel(value) ~= 6
        error('brdfit:badBounds', 'brdfit_fit: options.%s must have 6 numbers', name);
    end
    value = reshape(double(value), 1, 6);
end

function sum = terms_number(terms)
    names = {'diffuse', 'surface', 'volume', 'absorbing'};
    if ischar(terms)
        terms = strtrim(strsplit(terms, ','));
    end
    if ~iscellstr(terms)
        error('brdfit:badTerms', 'brdfit_fit: options.terms must be text');
    end
    if isequal(terms(:), {'all'})
        terms = names;
    end
    known = ismember(terms, names);
    if ~all(known)
        error('brdfit:badTerms', 'brdfit_fit: there is no term %s; they are %s', terms{find(~known, 1)}, strjoin(names, ', '));
    end
    sum = ismember(names, terms) * [1; 2; 4; 8];
end
