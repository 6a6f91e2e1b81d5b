function result = brdfit_program(command, theta_i, theta_s, brdf, options)
% BRDFIT_PROGRAM  What a command of the program brdfit says of a scan: all its models, and all that it finds.
%
%   result = brdfit_program('fit', theta_i, theta_s, brdf)
%   result = brdfit_program(command, theta_i, theta_s, brdf, options)
%
%   command   'fit', 'profile' or 'compare'
%   theta_i, theta_s, brdf   as for brdfit_fit: degrees and sr^-1
%   options   a struct: delta_phi and sigma as for brdfit_fit, and the options of the command, with _ in place of -:
%             true for one that takes no value, text or a number for others, a cell array of texts for one that is repeated.
%             Empty fields and false count as not given.
%   result    the struct of the command's JSON, such as result.model, result.parameters.m, result.mse2, result.minima,
%             result.uncertainty.stderr, result.uncertainty.undetermined, result.derived; null is []
%
%   Every model, and what brdfit_fit does not have:
%     r = brdfit_program('fit', ti, ts, f, struct('model', 'ggx-smith', 'terms', 'auto', 'robust', true));
%     r = brdfit_program('fit', ti, ts, f, struct('method', 'paper', 'prior', 'n=1.50+-0.02'));
%     r = brdfit_program('profile', ti, ts, f, struct('parameter', 'm', 'bootstrap', 100));
%
%   `brdfit fit --help`, or the guide, explains the options.
%
%   Errors: brdfit:badInput, brdfit:sizeMismatch, brdfit:badOption, brdfit:program with what the program says.
%
%   See also brdfit_fit, jsondecode.

    if nargin < 4 || nargin > 5
        error('brdfit:badInput', 'brdfit_program: takes command, theta_i, theta_s, brdf and, if need be, options');
    end
    if ~ischar(command) || ~any(strcmp(command, {'fit', 'profile', 'compare'}))
        error('brdfit:badInput', 'brdfit_program: the command must be ''fit'', ''profile'' or ''compare''');
    end
    if nargin < 5 || isempty(options)
        options = struct();
    end
    if ~isstruct(options) || numel(options) ~= 1
        error('brdfit:badOption', 'brdfit_program: options must be one struct');
    end
    if ~isnumeric(brdf) || ~isreal(brdf) || isempty(brdf)
        error('brdfit:badInput', 'brdfit_program: brdf must be an array of real numbers');
    end
    count = numel(brdf);
    rows = [brdfit_row('theta_i', theta_i, count); brdfit_row('theta_s', theta_s, count); double(brdf(:).')];
    heads = {'theta_i_deg', 'theta_s_deg', 'brdf_per_sr'};
    columns = struct('delta_phi', 'delta_phi_deg', 'sigma', 'sigma');
    words = {command, '-', '--format=json'};
    names = fieldnames(options);
    for k = 1:numel(names)
        [name, value] = deal(names{k}, options.(names{k}));
        if isempty(value)
            continue
        end
        if isfield(columns, name)
            rows(end + 1, :) = brdfit_row(['options.' name], value, count);
            heads{end + 1} = columns.(name);
        else
            words = [words, words_of(name, value)];
        end
    end
    format = [strjoin(repmat({'%.17g'}, 1, numel(heads)), ',') '\n'];
    table = [strjoin(heads, ',') sprintf('\n') sprintf(format, rows)];
    [wrong, text] = brdfit_mex('program', strjoin(words, sprintf('\n')), table);
    if wrong
        error('brdfit:program', 'brdfit_program: %s', text);
    end
    result = jsondecode(text);
end

function words = words_of(name, value)
    option = ['--' strrep(name, '_', '-')];
    if ischar(value)
        value = {value};
    end
    if islogical(value) && numel(value) == 1
        words = repmat({option}, 1, double(value));
    elseif iscellstr(value)
        words = cellfun(@(one) [option '=' one], value(:).', 'UniformOutput', false);
    elseif isnumeric(value) && isreal(value) && numel(value) == 1
        words = {sprintf('%s=%.17g', option, value)};
    else
        error('brdfit:badOption', 'brdfit_program: options.%s must be text, a number, true, or a cell array of texts', name);
    end
    if any(cellfun(@(one) any(one == 10), words))
        error('brdfit:badOption', 'brdfit_program: options.%s has a line break', name);
    end
end
