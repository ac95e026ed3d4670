!> A number for what an input says, by which a checkpoint knows the run that it belongs to.
module input_fingerprint
    use, intrinsic :: iso_fortran_env, only : int64
    use archive_file, only : mix_text
    use whole_file, only : next_line
    implicit none
    private

    public :: listing_fingerprint

    character(len=19), parameter :: without(5) = ['&output checkpoint ', '&output table_limit', &
        '&output length_unit', '&output force_unit ', '&output time_unit  ']

contains

    !> Another number for any other listing, but for keys that change no results.
    pure integer(int64) function listing_fingerprint(listing) result(number)
        character(len=*), intent(in) :: listing   !! of the namelists, a line a key
        integer :: first, last, line, i

        number = 0
        last = -1
        line = 0
        do while (last < len(listing) - 1)
            call next_line(listing, first, last, line)
            associate (text => listing(first:last + 1))
                if (all([(index(text, trim(without(i)) // ' ') /= 1, i = 1, size(without))])) then
                    call mix_text(text, number)
                end if
            end associate
        end do
    end function listing_fingerprint

end module input_fingerprint
